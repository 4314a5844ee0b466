// Method `scree`: what keyed bodies carry, throw and let go.  [A54]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0, kHalf = 0.1;

/// A plate, its top at the heights of the keys.
BodyId addPlate(World& world, MaterialId material, KeyInterpolation interpolation,
                const std::vector<std::pair<double, double>>& tops)
{
    std::vector<MotionKey> keys;
    for (const auto& [time, top] : tops)
        keys.push_back({time, {{0.0, top - kHalf, 0.0}, Quat::Identity()}});
    return addKeyedBody(world, boxShape({2.0, 2.0 * kHalf, 2.0}, 1), material, keys, interpolation);
}

/// How high the body comes if it flies on, above where it stood at first.
double highest(const World& world, BodyId body, double first, double g)
{
    const BodyMotion& motion = world.motion[body];
    const double v = motion.velocity.y();
    return motion.position.y() - first + 0.5 * v * v / g;
}

/// At the end of a frame in flight.
std::vector<double> heightsAfter(World& world, int frames, const std::vector<BodyId>& riders)
{
    const StepSettings settings = screeSettings();
    std::vector<double> first;
    for (const BodyId rider : riders) first.push_back(world.motion[rider].position.y());
    Stepper stepper(settings);
    for (int f = 0; f < frames; ++f) stepper.advanceFrame(world, kFrame);
    std::vector<double> heights;
    for (std::size_t i = 0; i < riders.size(); ++i)
        heights.push_back(highest(world, riders[i], first[i], settings.gravity.norm()));
    return heights;
}

// With the mean velocity of the step before it, what lay on a lift was thrown 2 to 9 % too high.
TEST(GapRiders, WhatABrakingLiftLetsGoFliesFromTheVelocityItsScriptHasThen)
{
    const double g = screeSettings().gravity.norm(), time = 12.0 * kFrame;
    for (const double braking : {15.0, 30.0, 60.0}) {  // at its end
        for (const bool isBall : {false, true}) {
            World world;
            const MaterialId material = addMaterial(world, 0.5, 0.0);
            const double way = braking * time * time / 6.0;
            addPlate(world, material, KeyInterpolation::smooth, {{0.0, 0.0}, {time, way}});
            std::vector<BodyId> riders;
            if (isBall) {
                riders.push_back(addBody(world, exactSphere(0.2), material,
                                         {{0.0, 0.2, 0.0}, Quat::Identity()}));
            } else {
                for (const double y : {0.2, 0.6})
                    riders.push_back(addBody(world, boxShape(Vec3::Constant(0.4), 1), material,
                                             {{0.0, y, 0.0}, Quat::Identity()}));
            }
            // It leaves when the plate brakes as much as gravity does.
            const double s = 0.5 * (1.0 + g / braking);
            const double v = way / time * 6.0 * s * (1.0 - s);
            const double height = way * s * s * (3.0 - 2.0 * s) + 0.5 * v * v / g;
            for (const double reached : heightsAfter(world, 13, riders))
                EXPECT_NEAR(reached, height, 5e-3 * height) << braking << " " << isBall;
        }
    }
}

TEST(GapRiders, WhereAScriptStopsSuddenlyItsRiderKeepsTheVelocityBefore)
{
    constexpr double kSpeed = 2.0;
    const double g = screeSettings().gravity.norm();
    for (const double frames : {12.0, 12.1, 12.5, 12.9}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        const double way = kSpeed * frames * kFrame;
        addPlate(world, material, KeyInterpolation::linear, {{0.0, 0.0}, {frames * kFrame, way}});
        const BodyId ball =
            addBody(world, exactSphere(0.2), material, {{0.0, 0.2, 0.0}, Quat::Identity()});
        const double height = way + 0.5 * kSpeed * kSpeed / g;
        EXPECT_NEAR(heightsAfter(world, 15, {ball})[0], height, 5e-3 * height) << frames;
    }
}

// Whoever leaves a plate that does not brake has been thrown by nothing.
TEST(GapRiders, WhatRollsOffTheEdgeOfAStillPlateFallsFromThere)
{
    constexpr double kSpeed = 3.0, kToTheEdge = 0.1;
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    addPlate(world, material, KeyInterpolation::linear, {{0.0, 0.0}, {1.0, 0.0}});
    const BodyId ball =
        addBody(world, exactSphere(0.2), material, {{1.0 - kToTheEdge, 0.2, 0.0}, Quat::Identity()},
                1.0, {kSpeed, 0.0, 0.0});
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    for (int f = 0; f < 8; ++f) stepper.advanceFrame(world, kFrame);
    // It is let go at the end of the step in which it passes the edge.
    const double time = 8.0 * kFrame - kToTheEdge / kSpeed;
    const double fallen = 0.5 * settings.gravity.norm() * time * time;
    EXPECT_NEAR(0.2 - world.motion[ball].position.y(), fallen, 0.03);
}

/// A box that a script moves along x over the ground: its time and place at each key.
void addPusher(World& world, MaterialId material, double height,
               const std::vector<std::pair<double, double>>& keys)
{
    std::vector<MotionKey> moves;
    for (const auto& [time, x] : keys)
        moves.push_back({time, {{x, height, 0.0}, Quat::Identity()}});
    addKeyedBody(world, boxShape(Vec3::Ones(), 1), material, moves, KeyInterpolation::smooth);
}

TEST(GapRiders, ABoxThatABrakingPusherLetsGoSlidesOnTheGround)
{
    constexpr double kFriction = 0.2, kTime = 0.5, kWay = 1.0;
    World world;
    const MaterialId material = addMaterial(world, kFriction, 0.0);
    addPlane(world, material);
    addPusher(world, material, 0.6, {{0.0, 0.0}, {kTime, kWay}});
    const BodyId box =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {{1.0, 0.5, 0.0}, Quat::Identity()});
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, kFrame);
    // It leaves when the pusher brakes more than friction.
    const double braking = kFriction * settings.gravity.norm();
    const double s = 0.5 * (1.0 + braking * kTime * kTime / (6.0 * kWay));
    const double v = kWay / kTime * 6.0 * s * (1.0 - s);
    const double way = kWay * s * s * (3.0 - 2.0 * s) + 0.5 * v * v / braking;
    EXPECT_NEAR(world.motion[box].position.x() - 1.0, way, 5e-3 * way);
    EXPECT_NEAR(world.motion[box].position.y(), 0.5, 1e-3);
}

// What a script takes away from others has given them nothing.
TEST(GapRiders, APusherThatDrawsBackLeavesWhatItTouchedWhereItIs)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addPusher(world, material, 0.5, {{0.0, -1.1}, {0.5, -0.9}, {1.0, -2.0}});
    const BodyId box =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    Stepper stepper(screeSettings());
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    EXPECT_NEAR(world.motion[box].position.x(), 0.1, 2e-3);
    EXPECT_LE(world.motion[box].velocity.norm(), 1e-6);
}

}  // namespace
}  // namespace scree::test
