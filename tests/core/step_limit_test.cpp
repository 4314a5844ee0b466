// The limit of the time step within a frame; that nothing tunnels is E12 of scree verify.  [A16]
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(StepLimit, StepsThatMustBecomeShorterWithinAFrameDoNotHalveToItsEnd)
{
    // So fast a fall that every frame ends with fourteen steps a frame more than it began with.
    // What was left of the frame once made the next step halve, and the next, down to the cap.
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    // Past a slope as steep as a wall, which it never touches but for all its box can say might.
    addPlane(world, material, Vec3(-5, 0, 0), Vec3(1.0, 0.05, 0.0).normalized());
    addBody(world, boxShape({0.2, 0.2, 0.2}, 1), material, {Vec3(0, 3000, 0), Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    settings.gravity = {0.0, -400.0, 0.0};
    Stepper stepper(settings);
    const double frame = 1.0 / 24.0;
    for (int i = 1; i <= 15; ++i) {
        const FrameReport report = stepper.advanceFrame(world, frame);
        EXPECT_FALSE(report.substepCapReached) << i;
        // A quarter of the box's thickness a step at the speed it ends with, in fours.
        const double speed = 400.0 * frame * i;
        const double wanted = std::ceil(frame * speed / (0.25 * 0.2) / 4.0) * 4.0;
        EXPECT_LE(report.steps, wanted + 4.0) << i;
        EXPECT_GE(report.shortestStep, frame / (1.2 * wanted + 8.0)) << i;
    }
}

}  // namespace
}  // namespace scree::test
