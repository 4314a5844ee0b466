// E12: what is fast and thin does not pass through, because time steps are limited.  [A16]
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Too thin for the default of twelve voxels; exact distances near the surface make up for that.
std::shared_ptr<const Shape> thinBox(const Vec3& size, int segments)
{
    ShapeSettings settings;
    settings.resolution = 256;
    return buildMeshShape("thin", makeBox(size, {segments, segments, segments}), settings);
}

/// How many of `shots` balls of 1 cm radius at 100 m/s get through a static plate of 1 cm.
int tunnelled(int shots, int stepsAllowed, double frame)
{
    const auto ball = buildMeshShape("ball", makeSphere(0.01, 2));
    const auto plate = thinBox({1.0, 1.0, 0.01}, 2);
    int count = 0;
    for (int i = 0; i < shots; ++i) {
        const auto u = [&](int k) {
            return 2.0 * randomUnit(12, static_cast<std::uint64_t>(i), k) - 1.0;
        };
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.5);
        addBody(world, plate, material, {Vec3::Zero(), Quat::Identity()}, 0.0);
        const Vec3 direction = Vec3(u(0), u(1), -0.5 - 0.5 * std::abs(u(2))).normalized();
        const Vec3 target(0.4 * u(3), 0.4 * u(4), 0.005);
        const double distance = 0.05 + 0.02 * u(5);
        const BodyId body =
            addBody(world, ball, material, {target - distance * direction, Quat::Identity()}, 0.03,
                    100.0 * direction);
        StepSettings settings = experimentSettings();
        settings.substeps.max = stepsAllowed;
        Stepper(settings).advanceFrame(world, frame);
        count += world.motion[body].position.z() < 0.0;
    }
    return count;
}

TEST(E12FastAndThin, OfAHundredFastBallsNoneGetsThroughAThinPlate)
{
    // 1/240 s takes the ball 0.4 m; at 2000 steps per 1/24 s that is a cap of 200.
    EXPECT_EQ(tunnelled(100, 200, 1.0 / 240.0), 0);
}

TEST(E12FastAndThin, WithoutTheLimiterNearlyAllGetThrough)
{
    EXPECT_GE(tunnelled(100, 1, 1.0 / 24.0), 90);
}

/// Whether a free rod of 2 m × 2 cm, spinning at 100 rad/s, sweeps through a fixed post.
bool rodPassesPost(int stepsAllowed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.5);
    const Vec3 post(0.5, 0.0, -0.5);
    addBody(world, boxShape({0.03, 1.0, 0.03}, 4), material, {post, Quat::Identity()}, 0.0);
    const BodyId rod =
        addBody(world, thinBox({2.0, 0.02, 0.02}, 20), material, {Vec3::Zero(), Quat::Identity()},
                1.0, Vec3::Zero(), {0.0, 100.0, 0.0});
    StepSettings settings = experimentSettings();
    settings.gravity.setZero();
    settings.substeps.max = stepsAllowed;
    Stepper stepper(settings);
    bool passes = false;
    double sideBefore = 0.0;
    for (int f = 0; f < 2; ++f) {
        stepper.advanceFrame(world, 0.01, {}, [&](const World& now, double) {
            const Vec3 local = inverse(now.worldFromAsset(rod)) * post;
            const bool isBeside = std::abs(local.x()) < 0.95;
            passes = passes || (isBeside && sideBefore * local.z() < 0.0);
            sideBefore = isBeside ? local.z() : 0.0;
        });
    }
    return passes;
}

TEST(E12FastAndThin, ASpinningRodDoesNotSweepThroughAPost)
{
    EXPECT_FALSE(rodPassesPost(500));
    EXPECT_TRUE(rodPassesPost(3));  // without the limiter it does
}

TEST(E12FastAndThin, WhereNothingMovesAFrameIsOneStepApartFromTheHoverLimit)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.5);
    addBody(world, boxShape(Vec3::Ones(), 2), material, {Vec3::Zero(), Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.gravity.setZero();
    EXPECT_EQ(Stepper(settings).advanceFrame(world, 1.0 / 24.0).steps, 1);
}

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
