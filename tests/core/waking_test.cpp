// What wakes sleepers, and what does not.
#include "core/dynamics/gaps/waking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/dynamics/gaps/sleep.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

/// Cubes of 1 m and 1 kg, one on the other.
World makeStack(int count)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < count; ++i) {
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(0.0, 0.5 + i, 0.0), Quat::Identity()});
    }
    return world;
}

// In their first step nothing has borne anything yet: all but the lowest layer were to fall freely,
// and had half of what a frame of gravity gives where contacts held them.
TEST(Waking, WhatSleptFromTheStartHasNoSpeedThatItDoesNotMoveBy)
{
    World world;
    const MaterialId wood = addMaterial(world, 0.5, 0.0);
    addPlane(world, wood);
    const double side = 0.2;
    std::vector<BodyId> boxes;
    for (int x = 0; x < 6; ++x) {
        for (int y = 0; y < 4; ++y) {
            for (int z = 0; z < 6; ++z)
                boxes.push_back(addBody(world, boxShape(Vec3::Constant(side), 1), wood,
                                        {side * Vec3(x, y + 0.5, z)}));
        }
    }
    const Vec3 ahead(-0.5 * side - 0.05 - 1e-3, 0.5, 2.5 * side), speed(0.02, 0.0, 0.0);
    addKeyedBody(world, boxShape({0.1, 1.0, 3.0}, 1), wood,
                 {{0.0, {ahead, Quat::Identity()}}, {1.0, {ahead + speed, Quat::Identity()}}},
                 KeyInterpolation::linear);
    const StepSettings settings = screeSettings();
    sleepFromTheStart(world, settings, boxes);
    Stepper stepper(settings);
    for (int f = 0; f < 6; ++f) {
        stepper.advanceFrame(world, kFrame);
        for (const BodyId box : boxes)
            ASSERT_GT(world.motion[box].velocity.y(), -0.02) << f << ", " << box;
    }
    EXPECT_FALSE(world.contactMemory.isAsleep(boxes.front()));
}

TEST(Waking, SleepersWakeAndMoveWhenStruckAndOnlyThen)
{
    World world = makeStack(3);
    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), 0, {Vec3(8.0, 0.5, 0.0), Quat::Identity()});
    Stepper stepper(screeSettings());
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    for (BodyId b = 1; b <= 4; ++b) ASSERT_TRUE(world.contactMemory.isAsleep(b)) << b;

    const World before = world;
    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), 0, {Vec3(-3.0, 1.5, 0.0), Quat::Identity()}, 5.0,
            Vec3(6.0, 3.0, 0.0));
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_GE((world.motion[2].position - before.motion[2].position).norm(), 0.1);
    // The cube that stands apart has not stirred by a bit.
    EXPECT_TRUE(world.motion[4].position == before.motion[4].position);
    EXPECT_TRUE(world.contactMemory.isAsleep(4));
}

TEST(Waking, AForceThatChangesWakesButNotWhatAirTakesFromTheLastCreep)
{
    World world = makeStack(1);
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    ASSERT_TRUE(world.contactMemory.isAsleep(1));
    std::vector<AppliedForce> forces;
    findForces(world, settings, kFrame, forces);
    forces[1].acceleration.x() += 1e-9;
    wakeByForces(world, forces);
    EXPECT_TRUE(world.contactMemory.isAsleep(1));
    forces[1].acceleration.x() += 0.1;
    wakeByForces(world, forces);
    EXPECT_FALSE(world.contactMemory.isAsleep(1));
}

// All slept, so that the frame in which a blast set in was one step, with the force of its middle:
// what it took along went half as far again.
TEST(Waking, WhatAForceTakesAlongMovesInAsManyStepsAsThatNeeds)
{
    constexpr double kLift = 2000.0;
    World world = makeStack(1);
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    ASSERT_TRUE(world.contactMemory.isAsleep(1));
    ForceField blast;  // upward, from far below
    blast.centre = Vec3(0.0, -1e6, 0.0);
    blast.keys = {{24.0 * kFrame, 0.0}, {25.0 * kFrame, kLift}};
    world.fields.push_back(blast);
    const double before = world.motion[1].position.y();
    stepper.advanceFrame(world, kFrame);
    const double carried = kFrame * -settings.gravity.y() / kLift;  // until the blast does [s]
    const double way = kLift / (6.0 * kFrame) * std::pow(kFrame - carried, 3);
    EXPECT_NEAR(world.motion[1].position.y() - before, way, 0.02 * way);
}

TEST(Waking, ABlowGoesThroughSleepersAsThroughWhatIsAwake)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    addPlane(world, material);
    const auto addBall = [&](double x, double speed) {
        return addBody(world, exactSphere(0.5), material, {Vec3(x, 0.5, 0.0), Quat::Identity()},
                       1.0, Vec3(speed, 0.0, 0.0));
    };
    constexpr int kBalls = 9;
    for (int i = 0; i < kBalls; ++i) addBall(i, 0.0);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    for (BodyId b = 1; b <= kBalls; ++b) ASSERT_TRUE(world.contactMemory.isAsleep(b)) << b;

    addBall(-3.0, 4.0);
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    // Were those out of reach of the first look left asleep, the blow would come back from them.
    EXPECT_NEAR(world.motion[kBalls].velocity.x(), 4.0, 0.05);
    for (BodyId b = 1; b < kBalls; ++b) EXPECT_NEAR(world.motion[b].velocity.x(), 0.0, 0.05) << b;
}

TEST(Waking, ASleeperPassesOnTheWeightOfWhatIsLaidOnIt)
{
    World world = makeStack(1);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    ASSERT_TRUE(world.contactMemory.isAsleep(1));

    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), 0, {Vec3(0.0, 1.5, 0.0), Quat::Identity()}, 0.2);
    // Long before the other sleeps too.
    for (int f = 0; f < 6; ++f) stepper.advanceFrame(world, kFrame);
    double onGround = 0.0;  // on body 0, the plane
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (contact.a == 0) onGround -= contact.force.y();
    }
    EXPECT_NEAR(onGround, 1.2 * experimentSettings().gravity.norm(), 0.1);
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_TRUE(world.contactMemory.isAsleep(1));
    EXPECT_TRUE(world.contactMemory.isAsleep(2));
}

// A tenth of what a hundred kilograms of plank bear in their contacts, on the lever of half their
// length, is what seven kilograms have at its end.
TEST(Waking, ABalancedSleeperGivesWayToWhatPressesOnItSteadily)
{
    World world;
    const MaterialId wood = addMaterial(world, 0.8, 0.0);
    addFixed(world, wood, boxShape({0.1, 0.5, 0.6}, 1), {Vec3(0.0, 0.25, 0.0)});
    addFixed(world, wood, boxShape({2.0, 0.1, 0.5}, 1), {Vec3(-3.02, 0.55, 0.0)});
    const BodyId plank =
        addBody(world, boxShape({4.0, 0.1, 0.5}, 1), wood, {Vec3(0.0, 0.55, 0.0)}, 100.0);
    addBody(world, exactSphere(0.1), wood, {Vec3(-2.8, 0.7, 0.0)}, 5.0, Vec3(0.5, 0.0, 0.0),
            Vec3(0.0, 0.0, -5.0));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 36; ++f) stepper.advanceFrame(world, kFrame);
    ASSERT_TRUE(world.contactMemory.isAsleep(plank));  // the ball is still on its shelf
    for (int f = 36; f < 96; ++f) stepper.advanceFrame(world, kFrame);
    const Vec3 along = world.motion[plank].orientation * Vec3::UnitX();
    EXPECT_GT(std::abs(along.y()), std::sin(5.0 * kPi / 180.0));
}

TEST(Waking, SleepersThatLoseWhatHoldsThemFall)
{
    World world = makeStack(3);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    for (BodyId b = 1; b <= 3; ++b) ASSERT_TRUE(world.contactMemory.isAsleep(b)) << b;
    // The middle one is carried away.
    world.motion[2].position.x() = 5.0;
    world.contactMemory.rest[2].isAsleep = false;
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_NEAR(world.motion[3].position.y(), 1.5, 1e-2);
}

// Without gravity nothing told it that it was no longer free: it stood for a step, and then caught
// up with its script at twice the speed.
TEST(Waking, WhatAScriptTakesOverMovesFromItsFirstStepOn)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    const BodyId taken =
        addKeyedBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                     {{36.0 * kFrame, {Vec3::Zero()}}, {48.0 * kFrame, {Vec3(1.2, 0.0, 0.0)}}},
                     KeyInterpolation::linear);
    world.info[taken].keyedFrom = 36;
    // Another that is awake, or no step would be made.
    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material, {Vec3(0.0, 9.0, 0.0)}, 1.0,
            Vec3(0.0, 0.01, 0.0));
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    Stepper stepper(settings);
    for (int f = 0; f < 36; ++f) stepper.advanceFrame(world, kFrame);
    ASSERT_TRUE(world.contactMemory.isAsleep(taken));
    for (int f = 1; f <= 3; ++f) {
        stepper.advanceFrame(world, kFrame);
        EXPECT_NEAR(world.motion[taken].position.x(), 0.1 * f, 1e-12) << f;
    }
}

}  // namespace
}  // namespace scree::test
