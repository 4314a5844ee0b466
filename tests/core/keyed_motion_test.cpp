// Keyed bodies: the curve through the keys, what they carry and push, release.  [A54, A55], E17
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/diagnostics/state_hash.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/stepper.h"
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

BodyId addKeyed(World& world, std::shared_ptr<const Shape> shape, MaterialId material,
                const std::vector<MotionKey>& keys, KeyInterpolation interpolation)
{
    BodyDefinition definition;
    definition.name = "keyed_" + std::to_string(world.bodyCount());
    definition.shape = world.addShape(std::move(shape));
    definition.material = material;
    definition.kind = BodyKind::keyed;
    definition.script = std::make_shared<MotionScript>(keys, interpolation);
    return world.addBody(definition);
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

/// A turntable of 1.5 m with a box at 1 m from its axis, for five seconds; how far out the box
/// gets.
double largestRadiusOnTurntable(double spin)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    std::vector<MotionKey> keys;
    for (int k = 0; k <= 12; ++k) {
        keys.push_back({0.5 * k, {{0.0, -0.1, 0.0}, aboutY(0.5 * k * spin)}});
    }
    addKeyed(world, boxShape({3.0, 0.2, 3.0}, 4), material, keys, KeyInterpolation::linear);
    const Vec3 start(1.0, 0.1, 0.0);
    const BodyId box =
        addBody(world, boxShape(Vec3::Constant(0.2), 2), material, {start, Quat::Identity()}, 8.0,
                Vec3(0.0, spin, 0.0).cross(start), {0.0, spin, 0.0});
    Stepper stepper(oneStepAFrame());
    double radius = 0.0;
    for (int k = 0; k < 5 * 240; ++k) {
        stepper.advanceFrame(world, kDt);
        const Vec3& x = world.motion[box].position;
        radius = std::max(radius, std::hypot(x.x(), x.z()));
        if (radius > 1.05) break;
    }
    return radius;
}

TEST(E17AcceleratedFrames, ABoxStaysOnATurntableBelowTheCriticalSpinAndLeavesAboveIt)
{
    EXPECT_LE(largestRadiusOnTurntable(2.1), 1.05);
    EXPECT_GT(largestRadiusOnTurntable(2.3), 1.05);
}

TEST(E17AcceleratedFrames, AStackOnALiftThatSpeedsUpAndDownKeepsItsLevelsAndItsPlace)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    // ±2 m/s²: half a second up, a second braking and turning, and so on. Keys 0.05 s apart, so the
    // lift's velocity steps by 0.1 m/s.
    std::vector<MotionKey> keys;
    double height = -0.1, speed = 0.0;
    for (int k = 0; k <= 104; ++k) {
        keys.push_back({0.05 * k, {{0.0, height, 0.0}, Quat::Identity()}});
        const double acceleration = (k / 10) % 4 == 0 || (k / 10) % 4 == 3 ? 2.0 : -2.0;
        height += 0.05 * (speed + 0.5 * 0.05 * acceleration);
        speed += 0.05 * acceleration;
    }
    const BodyId lift =
        addKeyed(world, boxShape({1.0, 0.2, 1.0}, 4), material, keys, KeyInterpolation::smooth);
    for (int i = 0; i < 5; ++i) {
        addBody(world, boxShape(Vec3::Constant(0.2), 2), material,
                {{0.0, 0.1 + 0.2 * i, 0.0}, Quat::Identity()}, 8.0);
    }
    Stepper stepper(oneStepAFrame());
    double drift = 0.0, lag = 0.0, fastest = 0.0;
    int otherLevels = 0;
    for (int k = 0; k < 5 * 240; ++k) {
        const FrameReport report = stepper.advanceFrame(world, kDt);
        otherLevels += report.sum.levels != 6;
        for (BodyId b = 1; b <= 5; ++b) {
            const Vec3 x = world.motion[b].position - world.motion[lift].position;
            drift = std::max(drift, std::hypot(x.x(), x.z()));
            lag = std::max(lag, std::abs(x.y() - (0.2 * b)));
        }
        fastest = std::max(fastest, world.motion[5].velocity.y());
    }
    EXPECT_LE(drift, 0.01);
    EXPECT_LE(lag, 0.01);
    EXPECT_GT(fastest, 0.8);  // the lift reaches 1 m/s and the stack goes with it
    EXPECT_EQ(otherLevels, 0);
}

TEST(E17AcceleratedFrames, APushedBoxMovesAsFastAsThePusher)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.0);
    addPlane(world, material);
    addKeyed(
        world, boxShape(Vec3::Constant(0.2), 2), material,
        {{0.0, {{-0.3, 0.1, 0.0}, Quat::Identity()}}, {4.0, {{3.7, 0.1, 0.0}, Quat::Identity()}}},
        KeyInterpolation::linear);
    const BodyId box = addBody(world, boxShape(Vec3::Constant(0.2), 2), material,
                               {{0.0, 0.1, 0.0}, Quat::Identity()}, 8.0);
    Stepper stepper(oneStepAFrame());
    for (int k = 0; k < 240; ++k) stepper.advanceFrame(world, kDt);
    EXPECT_NEAR(world.motion[box].velocity.x(), 1.0, 1e-6);
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
    World unbroken = makeHandOver(), broken = makeHandOver();
    Stepper stepper(experimentSettings());
    for (int f = 0; f < 14; ++f) {
        stepper.advanceFrame(unbroken, 1.0 / 24.0);
        if (f == 6) {
            EXPECT_EQ(unbroken.info[4].kind, BodyKind::keyed);
        }
    }
    EXPECT_EQ(unbroken.info[1].kind, BodyKind::dynamic);
    EXPECT_EQ(unbroken.info[4].kind, BodyKind::dynamic);
    while (broken.clock.frame < 14) {
        World fresh = makeHandOver();
        fresh.motion = broken.motion;
        fresh.order = broken.order;
        fresh.clock = broken.clock;
        broken = fresh;
        Stepper another(experimentSettings());
        another.advanceFrame(broken, 1.0 / 24.0, [] { return true; });
    }
    EXPECT_EQ(stateHash(broken), stateHash(unbroken));
}

TEST(E12FastAndThin, ABladeSweepingThroughLooseBoxesLeavesNoneInside)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.1);
    addPlane(world, material);
    std::vector<MotionKey> keys;
    for (int k = 0; k <= 8; ++k) keys.push_back({0.1 * k, {{0.0, 0.25, 0.0}, aboutY(1.5 * k)}});
    const BodyId blade =
        addKeyed(world, boxShape({2.0, 0.3, 0.05}, 4), material, keys, KeyInterpolation::linear);
    for (int i = 0; i < 6; ++i) {
        const double angle = 0.5 + 0.9 * i;
        addBody(world, boxShape(Vec3::Constant(0.2), 2), material,
                {{0.8 * std::cos(angle), 0.1, 0.8 * std::sin(angle)}, Quat::Identity()}, 2.0);
    }
    StepSettings settings = experimentSettings();
    Stepper stepper(settings);
    double worst = 0.0;
    for (int f = 0; f < 18; ++f) {
        const FrameReport report = stepper.advanceFrame(world, 1.0 / 24.0);
        worst = std::max(worst, report.sum.deepestAfterPushOut);
    }
    // The limiter counts the blade's own speed, 15 m/s at its tip: without that it steps over a box
    // and leaves it behind itself, or deep inside.
    EXPECT_LE(worst, 0.02);
    for (BodyId b = 2; b < 8; ++b) {
        const Vec3 x = world.motion[blade].worldFromBody().orientation.conjugate() *
                       (world.motion[b].position - world.motion[blade].position);
        EXPECT_FALSE(std::abs(x.x()) < 1.0 && std::abs(x.y()) < 0.2 && std::abs(x.z()) < 0.1) << b;
    }
}

}  // namespace
}  // namespace scree::test
