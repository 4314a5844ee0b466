// When a body that lies still is taken out of the simulation.
#include "core/dynamics/gaps/sleep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

TEST(Sleep, WhatLiesStillSleepsAfterTwelveFramesAndNoSooner)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId block =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    settings.sleep = true;
    Stepper stepper(settings);
    int frames = 0;
    for (; frames < 100 && !world.contactMemory.isAsleep(block); ++frames)
        stepper.advanceFrame(world, kFrame);
    EXPECT_GE(frames, 12);
    EXPECT_LE(frames, 15);
}

TEST(Sleep, WhatRollsOnABodyThatLiesStillKeepsItNotAwake)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId slab = addBody(world, boxShape({20.0, 1.0, 4.0}, 1), material,
                                {Vec3(0.0, 0.5, 0.0), Quat::Identity()}, 100.0);
    const BodyId ball =
        addBody(world, exactSphere(0.25), material, {Vec3(-5.0, 1.25, 0.0), Quat::Identity()}, 1.0,
                Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -4.0));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 72; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_TRUE(world.contactMemory.isAsleep(slab));
    EXPECT_FALSE(world.contactMemory.isAsleep(ball));
    EXPECT_NEAR(world.motion[ball].position.x(), -2.0, 1e-3);
    EXPECT_NEAR(world.motion[ball].position.y(), 1.25, 1e-4);
}

TEST(Sleep, SlowMotionPutsNothingToSleepThatIsAboutToMove)
{
    World world;
    const MaterialId material = addMaterial(world, 0.57, 0.0);  // holds up to 29.7 degrees
    const Quat tilt = fromEulerXyz({0.0, 0.0, -30.0 * kPi / 180.0});
    addPlane(world, material, Vec3::Zero(), tilt * Vec3::UnitY());
    addBody(world, boxShape(Vec3::Constant(0.5), 1), material, {tilt * Vec3(0.0, 0.25, 0.0), tilt});
    const Vec3 start = world.motion[1].position;
    Stepper stepper(screeSettings());
    for (int f = 0; f < 1000; ++f) stepper.advanceFrame(world, 1e-3);
    const double pull = 9.8 * (std::sin(kPi / 6.0) - 0.57 * std::cos(kPi / 6.0));
    EXPECT_NEAR((world.motion[1].position - start).norm(), 0.5 * pull, 0.02 * pull);
}

/// How far a box has come in nine seconds under a push that grows until friction gives way.
double slidUnderGrowingPush(bool mayRest)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId box =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    ForceField push;
    push.kind = ForceField::Kind::uniform;
    push.direction = Vec3::UnitX();
    push.keys = {{0.0, 0.0}, {10.0, 6.0}};
    world.fields = {push};
    StepSettings settings = screeSettings();
    settings.sleep = mayRest;
    Stepper stepper(settings);
    for (int f = 0; f < 9 * 24; ++f) stepper.advanceFrame(world, kFrame);
    return world.motion[box].position.x();
}

// It fell asleep for a frame between any two in which the force woke it, began a tenth of a second
// late, and was calmed as if it rocked.
TEST(Sleep, AForceThatGrowsMovesABodyWhenItShould)
{
    const double slid = slidUnderGrowingPush(false);
    EXPECT_GT(slid, 0.05);
    EXPECT_NEAR(slidUnderGrowingPush(true), slid, 1e-3 * slid);
}

TEST(Sleep, WhatFliesNeverSleepsHoweverSlowlyOrSteadily)
{
    StepSettings settings = screeSettings();
    settings.gravity.setZero();
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const Vec3 oneTurnAFrame(0.0, 2.0 * kPi / kFrame, 0.0);
    addBody(world, boxShape({1.0, 0.1, 0.1}, 1), material, {Vec3::Zero(), Quat::Identity()}, 1.0,
            Vec3::Zero(), oneTurnAFrame);
    addBody(world, boxShape(Vec3::Constant(100.0), 1), material,
            {Vec3(200.0, 0.0, 0.0), Quat::Identity()}, 1.0, {0.015, 0.0, 0.0});
    Stepper stepper(settings);
    for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_LE((angularVelocityOf(world, 0) - oneTurnAFrame).norm(), 1e-6);
    EXPECT_NEAR(world.motion[1].position.x(), 200.03, 1e-9);
}

TEST(Sleep, WhatTurnsOnceAFrameWhereItStandsDoesNotSleep)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    const Vec3 oneTurnAFrame(0.0, 2.0 * kPi / kFrame, 0.0);
    addPlane(world, material);
    addBody(world, exactSphere(0.5), material, {{0.0, 0.5, 0.0}, Quat::Identity()}, 1.0,
            Vec3::Zero(), oneTurnAFrame);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 96; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_LE((angularVelocityOf(world, 1) - oneTurnAFrame).norm(), 1e-6);
}

/// How far a step of a pyramid of 325 bricks that lies there already, but for velocities of up to
/// about `wobble`, is from one that is solved to its end, if `staying` of its bricks have been near
/// their places for long: the largest difference of velocities [m/s].
double leftUnsolved(int staying, double wobble)
{
    const auto velocitiesWith = [&](int sweeps) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addPlane(world, material);
        const auto brick = boxShape({2.0, 1.0, 1.0}, 1);
        std::vector<Vec3> wobbles(1, Vec3::Zero());
        for (int course = 0; course < 25; ++course) {
            for (int i = 0; i < 25 - course; ++i) {
                addBody(world, brick, material, {Vec3(2.1 * i + 1.05 * course, 0.5 + course, 0.0)});
                wobbles.push_back(wobble *
                                  Vec3(std::sin(course), std::sin(i), std::sin(i + course)));
            }
        }
        world.frameDuration = kFrame;
        world.contactMemory.rest.resize(world.bodyCount());
        for (int i = 1; i <= staying; ++i) world.contactMemory.rest[i].nearby.frames = 1000;
        StepSettings settings = screeSettings();
        Stepper(settings).step(world, kFrame);
        for (std::size_t i = 0; i < wobbles.size(); ++i) world.motion[i].velocity += wobbles[i];
        if (sweeps > 0) settings.gapSweeps = sweeps;
        Stepper(settings).step(world, kFrame);
        std::vector<Vec3> velocities;
        for (const BodyMotion& motion : world.motion) velocities.push_back(motion.velocity);
        return velocities;
    };
    const std::vector<Vec3> usual = velocitiesWith(0), exact = velocitiesWith(3000);
    double most = 0.0;
    for (std::size_t i = 0; i < usual.size(); ++i)
        most = std::max(most, (usual[i] - exact[i]).norm());
    return most;
}

// With the sweeps of a heap that moves, one that has nearly come to rest crept on for good.
TEST(Sleep, ALargeHeapIsSolvedToTheEndOnceItSettles)
{
    EXPECT_LE(leftUnsolved(300, 0.2), 0.5 * leftUnsolved(290, 0.2));
}

// With those sweeps walls leaned out by millimetres before they slept.
TEST(Sleep, AHeapThatHardlyMovesIsSolvedToItsEnd)
{
    EXPECT_LE(leftUnsolved(0, 1e-3), 0.1 * 1e-3);
}

}  // namespace
}  // namespace scree::test
