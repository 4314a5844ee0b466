// What swings loses no more energy than friction and blows take.
#include <gtest/gtest.h>

#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

// The energy is counted once the ring hangs tight. By the tangent of each step's beginning the ring
// lost 2.9 J, and with a quarter of the step 0.8 J.
TEST(GapSwings, ARingThatHangsInAnotherKeepsItsEnergy)
{
    World world;
    StepSettings settings = screeSettings();
    settings.substeps.min = settings.substeps.max = 8;
    const MaterialId material = addMaterial(world, 1.0, 0.0);
    const double inner = 0.35, mass = 10.0;
    const auto ring = buildMeshShape("ring", makeTorus(0.4, 0.4 - inner, {96, 32}));
    addFixed(world, material, ring, {Vec3::Zero(), exponentialMap({0.5 * kPi, 0.0, 0.0})});
    const Quat leaning = exponentialMap({0.0, 0.0, kPi / 3.0});
    addBody(world, ring, material,
            {Vec3(0.0, -inner, 0.0) + leaning * Vec3(0.0, -inner, 0.0),
             leaning * exponentialMap({0.0, 0.0, 0.5 * kPi})},
            mass);
    Stepper stepper(settings);
    const auto energyAfter = [&](int frames) {
        for (int k = 0; k < frames; ++k) stepper.advanceFrame(world, kFrame);
        return mechanicalEnergy(world, settings.gravity);
    };
    const double start = energyAfter(12), end = energyAfter(72);
    const double hanging = -mass * settings.gravity.norm() * 2.0 * inner;
    EXPECT_GT(start - hanging, 15.0);
    EXPECT_LT(end, start);
    EXPECT_GT(end, start - 1.9);
}

}  // namespace
}  // namespace scree::test
