// When a body that lies still is taken out of the simulation.
#include "core/dynamics/sleep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

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
        stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_GE(frames, 12);
    EXPECT_LE(frames, 15);
}

// Taken for something that rocks in its place, it was held at a few millimetres a second.
TEST(Sleep, WhatSlidesOnASlopeBarelySteeperThanFrictionHoldsGoesOnFasterAndFaster)
{
    constexpr double kSlope = 20.0 * kPi / 180.0;
    for (const double acceleration : {0.005, 0.01, 0.03}) {
        World world;
        const StepSettings settings = screeSettings();
        const double g = settings.gravity.norm();
        const MaterialId material =
            addMaterial(world, std::tan(kSlope) - acceleration / (g * std::cos(kSlope)), 0.0);
        const Vec3 normal(std::sin(kSlope), std::cos(kSlope), 0.0);
        addPlane(world, material, Vec3::Zero(), normal);
        const BodyId block = addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                                     {0.25 * normal, fromEulerXyz({0.0, 0.0, -kSlope})});
        const Vec3 start = world.motion[block].position;
        Stepper stepper(settings);
        for (int f = 0; f < 240; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        const double way = 0.5 * acceleration * 100.0;
        EXPECT_NEAR((world.motion[block].position - start).norm(), way, 0.02 * way) << acceleration;
    }
}

}  // namespace
}  // namespace scree::test
