// What swings or rides on what turns goes round, and does not leave its circle bit by bit.
#include <gtest/gtest.h>

#include <cmath>

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

// By the places of each step's beginning the blocks were 96 mm farther out after 8 s, and the disc
// turned by 114.7 degrees a second.
TEST(GapSwings, WhatRidesOnADiscThatTurnsStaysThere)
{
    World world;
    const MaterialId rough = addMaterial(world, 0.9, 0.0), ice = addMaterial(world, 0.0, 0.0);
    world.materialPairs.push_back({ice, rough, 0.0, {}});
    addPlane(world, ice);
    const double turning = 120.0 * kPi / 180.0;
    const Vec3 spin(0.0, turning, 0.0);
    const BodyId disc = addBody(world, buildMeshShape("disc", makeCylinder(1.0, 0.1, 64, 2)), rough,
                                {Vec3(0.0, 0.05, 0.0)}, 250.0, Vec3::Zero(), spin);
    const auto block = boxShape(Vec3::Constant(0.25), 2);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 place(0.5 * side, 0.225, 0.0);
        addBody(world, block, rough, {place}, 31.0, spin.cross(place), spin);
    }
    Stepper stepper(screeSettings());
    for (int f = 0; f < 8 * 24; ++f) stepper.advanceFrame(world, kFrame);
    for (const BodyId rider : {disc + 1, disc + 2}) {
        const Vec3 out = world.motion[rider].position - world.motion[disc].position;
        EXPECT_NEAR(std::hypot(out.x(), out.z()), 0.5, 2e-3) << rider;
    }
    EXPECT_NEAR(angularVelocityOf(world, disc).y(), turning, 1e-3 * turning);
}

}  // namespace
}  // namespace scree::test
