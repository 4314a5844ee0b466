// Keyed bodies: the curve through the keys, release. What they carry and push is E17 of scree
// verify.  [A54, A55]
#include <gtest/gtest.h>

#include <memory>

#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "tests/support/broken_run.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 240.0;

StepSettings oneStepAFrame()
{
    StepSettings settings = experimentSettings();
    settings.substeps.max = 1;
    return settings;
}

Quat aboutY(double angle)
{
    return exponentialMap({0.0, angle, 0.0});
}

TEST(MotionScript, LinearMotionIsSteadyAndHoldsBeforeAndAfter)
{
    const MotionScript script(
        {{1.0, {{1.0, 0.0, 0.0}, aboutY(0.0)}}, {3.0, {{5.0, 2.0, 0.0}, aboutY(1.0)}}},
        KeyInterpolation::linear);
    EXPECT_EQ(script.at(-5.0).position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(script.at(7.0).position, Vec3(5.0, 2.0, 0.0));
    for (double t = 1.0; t <= 3.0; t += 0.125) {
        // Rounding of a handful of operations on numbers of size 5.
        EXPECT_LE((script.at(t).position - Vec3(1.0 + 2.0 * (t - 1.0), t - 1.0, 0.0)).norm(),
                  1e-14);
        EXPECT_LE(script.at(t).orientation.angularDistance(aboutY(0.5 * (t - 1.0))), 1e-7);
    }
}

TEST(MotionScript, SmoothMotionRestsAtTheEndsPassesKeysWithoutAKinkAndNeverOvershoots)
{
    const MotionScript script({{0.0, {Vec3::Zero(), aboutY(0.0)}},
                               {1.0, {{1.0, 0.0, 0.0}, aboutY(0.5)}},
                               {2.0, {{4.0, 0.0, 0.0}, aboutY(2.5)}},
                               {3.0, {{4.0, 0.0, 0.0}, aboutY(2.5)}}},
                              KeyInterpolation::smooth);
    const double h = 1e-5;
    const auto velocity = [&](double t) {
        return Vec3((script.at(t + h).position - script.at(t - h).position) / (2.0 * h));
    };
    const auto turnRate = [&](double t) {
        return script.at(t + h).orientation.angularDistance(script.at(t - h).orientation) /
               (2.0 * h);
    };
    EXPECT_LE(velocity(h).norm(), 1e-3);
    EXPECT_LE((velocity(1.0 - 2 * h) - velocity(1.0 + 2 * h)).norm(), 1e-3);
    EXPECT_NEAR(turnRate(1.0 - 2 * h), turnRate(1.0 + 2 * h), 1e-3);
    EXPECT_GT(velocity(1.0).x(), 0.5);  // it does pass the key
    double before = 0.0;
    for (double t = 0.0; t <= 3.0; t += 0.01) {
        const double x = script.at(t).position.x();
        EXPECT_GE(x, before - 1e-12) << t;
        EXPECT_LE(x, 4.0 + 1e-12) << t;
        before = x;
    }
}

TEST(MotionScript, ASlowStretchBeforeAFastOneTurnsBackNowhere)
{
    // The mean of both speeds is more than three times the slower one.
    const MotionScript script({{0.0, {Vec3::Zero(), aboutY(0.0)}},
                               {1.0, {{1.0, 0.0, 0.0}, aboutY(0.1)}},
                               {2.0, {{12.0, 0.0, 0.0}, aboutY(1.2)}}},
                              KeyInterpolation::smooth);
    Pose before = script.at(0.0);
    for (double t = 0.01; t <= 1.0; t += 0.01) {
        const Pose pose = script.at(t);
        EXPECT_GE(pose.position.x(), before.position.x() - 1e-12) << t;
        EXPECT_LE(pose.position.x(), 1.0 + 1e-12) << t;
        EXPECT_GE(pose.orientation.y(), before.orientation.y() - 1e-12) << t;
        before = pose;
    }
}

TEST(MotionScript, WhatRestsInOneDirectionUntilAKeyStaysThere)
{
    // A hand slides over a table and then lifts and tilts; upright until then.
    const MotionScript script({{0.0, {{-0.4, 0.022, 0.0}, aboutY(0.0)}},
                               {1.0, {{0.2, 0.022, 0.0}, aboutY(0.6)}},
                               {1.5, {{0.5, 0.2, 0.0}, aboutY(0.9) * exponentialMap({0.5, 0, 0})}}},
                              KeyInterpolation::smooth);
    for (double t = 0.0; t <= 1.0; t += 0.01) {
        const Pose pose = script.at(t);
        EXPECT_NEAR(pose.position.y(), 0.022, 1e-15) << t;
        EXPECT_NEAR((pose.orientation * Vec3::UnitY()).y(), 1.0, 1e-15) << t;
    }
    EXPECT_GT(script.at(1.02).position.x() - script.at(1.0).position.x(), 0.005);  // passes
}

TEST(MotionScript, BoundsHoldWhateverSpanIsAsked)
{
    const MotionScript script({{0.0, {Vec3::Zero(), aboutY(0.0)}},
                               {1.0, {{1.0, 3.0, 0.0}, exponentialMap({0.4, 0.5, 0.1})}},
                               {1.5, {{4.0, 1.0, 2.0}, exponentialMap({-0.4, 1.5, 0.6})}},
                               {3.0, {{5.0, 0.0, 2.0}, exponentialMap({0.0, 2.5, -0.6})}}},
                              KeyInterpolation::smooth);
    for (double from = -0.2; from < 3.2; from += 0.17) {
        const double to = from + 0.3;
        const ScriptBounds bounds = script.boundsBetween(from, to);
        Vec3 low = bounds.velocities.front(), high = low;
        for (const Vec3& v : bounds.velocities) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        for (double t = from; t < to - 0.01; t += 0.01) {
            const Pose p = script.at(t), q = script.at(t + 0.01);
            const Vec3 v = (q.position - p.position) / 0.01;
            // A mean velocity lies in the hull of the velocities; rounding apart.
            EXPECT_TRUE((v.array() >= low.array() - 1e-9).all()) << t;
            EXPECT_TRUE((v.array() <= high.array() + 1e-9).all()) << t;
            EXPECT_LE(p.orientation.angularDistance(q.orientation) / 0.01, bounds.spin + 1e-6);
        }
    }
}

TEST(KeyedMotion, AReleasedBodyFliesOnWithTheVelocityAndSpinOfItsLastStep)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    BodyDefinition definition;
    definition.name = "thrown";
    definition.shape = world.addShape(boxShape({0.2, 0.4, 0.6}, 1));
    definition.material = material;
    definition.kind = BodyKind::keyed;
    const Vec3 turn(0.3, 0.2, -0.4);
    definition.script = std::make_shared<MotionScript>(
        std::vector<MotionKey>{{0.0, {Vec3::Zero(), Quat::Identity()}},
                               {1.0, {{2.0, 1.0, 0.0}, exponentialMap(turn)}}},
        KeyInterpolation::linear);
    definition.keyedUntil = 12;
    const BodyId body = world.addBody(definition);
    EXPECT_FALSE(world.mass[body].isMovable());

    StepSettings settings = oneStepAFrame();
    settings.gravity.setZero();
    Stepper stepper(settings);
    for (int f = 0; f < 12; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_LE((world.motion[body].position - Vec3(1.0, 0.5, 0.0)).norm(), 1e-12);
    const Vec3 spin = angularVelocityOf(world, body);
    EXPECT_LE((spin - turn).norm(), 1e-9);
    stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_TRUE(world.mass[body].isMovable());
    EXPECT_LE((world.motion[body].velocity - Vec3(2.0, 1.0, 0.0)).norm(), 1e-9);
    EXPECT_LE((world.motion[body].position - Vec3(2.0, 1.0, 0.0) * (13.0 / 24.0)).norm(), 1e-9);
}

TEST(KeyedMotion, WhatIsReleasedHasTheVelocityOfItsCurveJustThen)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    BodyDefinition definition;
    definition.name = "thrown";
    definition.shape = world.addShape(boxShape(Vec3::Ones(), 1));
    definition.material = material;
    definition.kind = BodyKind::keyed;
    const Vec3 turn(0.0, 0.8, 0.0);
    definition.script = std::make_shared<MotionScript>(
        std::vector<MotionKey>{{0.0, {Vec3::Zero(), Quat::Identity()}},
                               {1.0, {{2.0, 1.0, 0.0}, exponentialMap(turn)}}},
        KeyInterpolation::smooth);
    definition.keyedUntil = 6;
    const BodyId body = world.addBody(definition);
    StepSettings settings = oneStepAFrame();
    settings.gravity.setZero();
    Stepper stepper(settings);
    for (int f = 0; f < 7; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    // Of the share that has passed, s = 1/4, the slope of 3 s² - 2 s³.
    constexpr double kSlope = 1.125;
    EXPECT_LE((world.motion[body].velocity - kSlope * Vec3(2.0, 1.0, 0.0)).norm(), 1e-3);
    EXPECT_LE((angularVelocityOf(world, body) - kSlope * turn).norm(), 1e-3);
}

/// A keyed ram that is released while it pushes two boxes, and a box that a script takes over.
World makeHandOver()
{
    World world;
    const MaterialId material = addMaterial(world, 0.4, 0.2);
    addPlane(world, material);
    BodyDefinition ram;
    ram.name = "ram";
    ram.shape = world.addShape(boxShape(Vec3::Constant(0.4), 2));
    ram.material = material;
    ram.kind = BodyKind::keyed;
    ram.script = std::make_shared<MotionScript>(
        std::vector<MotionKey>{{0.0, {{-0.6, 0.2, 0.0}, Quat::Identity()}},
                               {0.5, {{0.6, 0.25, 0.1}, exponentialMap({0.0, 0.0, -0.5})}}},
        KeyInterpolation::smooth);
    ram.keyedUntil = 8;
    world.addBody(ram);
    for (int i = 0; i < 2; ++i) {
        addBody(world, boxShape(Vec3::Constant(0.4), 2), material,
                {{0.0, 0.2 + 0.4 * i, 0.0}, Quat::Identity()}, 8.0);
    }
    BodyDefinition taken = ram;
    taken.name = "taken";
    taken.kind = BodyKind::dynamic;
    taken.worldFromAsset = {{2.0, 1.0, 0.0}, Quat::Identity()};
    taken.keyedFrom = 5;
    taken.keyedUntil = 10;
    world.addBody(taken);
    return world;
}

TEST(KeyedMotion, StoppingBetweenSubStepsAcrossReleaseAndTakeOverChangesNothing)
{
    World unbroken = makeHandOver();
    Stepper stepper(experimentSettings());
    for (int f = 0; f < 14; ++f) {
        stepper.advanceFrame(unbroken, 1.0 / 24.0);
        if (f == 6) {
            EXPECT_EQ(unbroken.info[4].kind, BodyKind::keyed);
        }
    }
    EXPECT_EQ(unbroken.info[1].kind, BodyKind::dynamic);
    EXPECT_EQ(unbroken.info[4].kind, BodyKind::dynamic);
    int stops = 0;
    const World broken = runBroken(makeHandOver, experimentSettings(), 14, stops);
    EXPECT_GT(stops, 14);
    EXPECT_EQ(stateHash(broken), stateHash(unbroken));
}

// A tilted rod that turns about the vertical has angular momentum in another direction: made where
// the rod is and divided by its inertia where it will be, it had a spin about itself too, and took
// a ball at half its height upwards.  [A54]
TEST(KeyedMotion, WhatAScriptTurnsStrikesWithTheSpinOfTheScript)
{
    World world;
    const MaterialId material = addMaterial(world, 100.0, 0.0);
    const double turn = 0.3, dt = 1.0 / 24.0, half = 0.1, radius = 0.1;
    const Quat tilted = exponentialMap({0.0, 0.0, 0.25 * kPi});
    addKeyedBody(world, boxShape({2.0, 2.0 * half, 2.0 * half}, 1), material,
                 {{0.0, {Vec3::Zero(), exponentialMap({0.0, -0.5 * turn, 0.0}) * tilted}},
                  {dt, {Vec3::Zero(), exponentialMap({0.0, 0.5 * turn, 0.0}) * tilted}}},
                 KeyInterpolation::linear);
    const BodyId ball = addBody(world, exactSphere(radius), material,
                                {Vec3(0.0, 0.0, half + radius + 0.01)}, 1.0, {0.0, 0.0, -1.0});
    StepSettings settings = experimentSettings();
    settings.gravity = Vec3::Zero();
    settings.pushOut = false;
    Stepper(settings).step(world, dt);
    const Vec3 v = world.motion[ball].velocity;
    EXPECT_GT(v.x(), 0.2);
    EXPECT_NEAR(v.y(), 0.0, 1e-12);
}

}  // namespace
}  // namespace scree::test
