// E4: stacks of cubes, as meshes with distance fields from OpenVDB and true normals. [GBF03 figure
// 6]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// `count` cubes of 1 m and 1 kg on a floor, body 1 the lowest; offsets pseudo-random up to
/// `offset`.
World makeStack(int count, double offset)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < count; ++i) {
        const auto sideways = [&](int axis) {
            return offset * (2.0 * randomUnit(2003, static_cast<std::uint64_t>(i), axis) - 1.0);
        };
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{sideways(0), 0.5 + i, sideways(1)}, Quat::Identity()});
    }
    return world;
}

struct StackResult {
    double sink = 0.0, drift = 0.0, speed = 0.0;
    int levels = 0;
};

StackResult run(World world, const StepSettings& settings, double seconds)
{
    const World before = world;
    Stepper stepper(settings);
    StackResult result;
    for (int k = 0; k < seconds * 240.0; ++k) {
        result.levels = stepper.step(world, 1.0 / 240.0).levels;
        for (std::size_t b = 1; b < world.bodyCount(); ++b) {
            Vec3 moved = world.motion[b].position - before.motion[b].position;
            moved.y() = 0.0;
            result.drift = std::max(result.drift, moved.norm());
        }
    }
    const std::size_t top = world.bodyCount() - 1;
    result.sink = before.motion[top].position.y() - world.motion[top].position.y();
    for (std::size_t b = 1; b < world.bodyCount(); ++b) {
        result.speed = std::max(result.speed, world.motion[b].velocity.norm());
    }
    return result;
}

TEST(E4Stack, TenAlignedMeshCubesStandForFiveSeconds)
{
    const StackResult result = run(makeStack(10, 0.0), experimentSettings(), 5.0);
    EXPECT_LE(std::abs(result.sink), 2e-3);
    EXPECT_LE(result.drift, 5e-3);
    EXPECT_LE(result.speed, 5e-3);
    EXPECT_EQ(result.levels, 11);
}

TEST(E4Stack, TwentyOffsetCubesStandForFiveSeconds)
{
    const StackResult result = run(makeStack(20, 0.05), experimentSettings(), 5.0);
    EXPECT_LE(result.drift, 0.1);
    EXPECT_LE(std::abs(result.sink), 0.01);
}

TEST(E4Stack, WithoutShockPropagationTheStackFalls)
{
    StepSettings settings = experimentSettings();
    settings.shockPropagation = false;
    const StackResult result = run(makeStack(20, 0.05), settings, 4.0);
    EXPECT_GT(std::max(result.drift, std::abs(result.sink)), 0.5);
}

TEST(E4Stack, AnotherSeedGivesOtherBitsAndStandsAsWell)
{
    StepSettings settings = experimentSettings();
    settings.seed = 7;
    const StackResult result = run(makeStack(10, 0.0), settings, 5.0);
    EXPECT_LE(std::abs(result.sink), 2e-3);
    EXPECT_LE(result.drift, 5e-3);
}

}  // namespace
}  // namespace scree::test
