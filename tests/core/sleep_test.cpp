// When a body that lies still is taken out of the simulation.
#include "core/dynamics/sleep.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace scree::test
