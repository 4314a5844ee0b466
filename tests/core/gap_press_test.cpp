// What is pressed between keyed bodies, or one and the ground, where no velocity is right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/dynamics/stepper.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 24.0;

/// A plate over the ground whose lower face comes down from `from` by `by` in `seconds`.
BodyId addPlate(World& world, MaterialId material, double from, double by, double seconds)
{
    return addKeyedBody(world, boxShape({4.0, 0.2, 4.0}, 2), material,
                        {{0.0, {{0.0, from + 0.1, 0.0}, Quat::Identity()}},
                         {seconds, {{0.0, from + 0.1 - by, 0.0}, Quat::Identity()}}},
                        KeyInterpolation::linear);
}

double fastestOf(const World& world, const std::vector<BodyId>& bodies)
{
    double fastest = 0.0;
    for (const BodyId body : bodies)
        fastest = std::max(fastest, world.motion[body].velocity.norm());
    return fastest;
}

TEST(GapPress, TwoBallsInALineUnderAPlateAreNotThrown)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.2);
    addPlane(world, material);
    addPlate(world, material, 1.02, 0.5, 0.6);
    std::vector<BodyId> balls;
    for (const double y : {0.25, 0.75})
        balls.push_back(
            addBody(world, exactSphere(0.25), material, {{0.0, y, 0.0}, Quat::Identity()}));
    Stepper stepper(screeSettings());
    int steps = 0;
    for (int k = 0; k < 24; ++k) {
        steps = std::max(steps, stepper.advanceFrame(world, kDt).steps);
        // The plate has 0.83 m/s. A ball that slips out beside the other may be some times faster;
        // they had 700 m/s.
        ASSERT_LT(fastestOf(world, balls), 8.0) << k;
    }
    EXPECT_LT(steps, 64);
}

// It weighs four tons, and its own mass hid what it did: the cubes had 200 m/s.
TEST(GapPress, WhatIsNotMovedByTheCubesItFallsOnDoesNotThrowThem)  // [A57]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.1);
    addPlane(world, material);
    const double side = 0.3, half = 0.5 * side;
    std::vector<BodyId> cubes;
    for (const double x : {-0.4, 0.4}) {
        for (const double z : {-0.4, 0.4}) {
            for (int k = 0; k < 3; ++k)
                cubes.push_back(addBody(world, boxShape(Vec3::Constant(side), 1), material,
                                        {Vec3(x, half + side * k, z), Quat::Identity()}, 27.0));
        }
    }
    const BodyId slab = addBody(
        world, boxShape({3.0, 0.5, 3.0}, 1), material,
        {Vec3(0.0, 2.15, 0.0), fromEulerXyz({3.0 * kPi / 180.0, 0.0, 2.0 * kPi / 180.0})}, 4500.0);
    for (const BodyId cube : cubes) world.traits[cube].groups.group = 2;
    world.traits[slab].groups.unmovedBy = 2;
    Stepper stepper(screeSettings());
    for (int k = 0; k < 48; ++k) {
        stepper.advanceFrame(world, kDt);
        ASSERT_LT(fastestOf(world, cubes), 10.0) << k;
    }
}

/// Where there is a way out it is taken, however far impulses go beyond what the ball weighs.
TEST(GapPress, ABallInAWedgeThatClosesLeavesItAtTheSpeedOfRigidBodies)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    const double angle = 10.0 * kPi / 180.0, radius = 0.25;
    const Vec3 up{std::sin(angle), std::cos(angle), 0.0};
    addPlane(world, material, Vec3::Zero(), up);
    const Vec3 centre = radius * up;
    addPlate(world, material, centre.y() + radius + 0.01, 0.5, 1.0);
    const BodyId ball = addBody(world, exactSphere(radius), material, {centre, Quat::Identity()});
    StepSettings settings = screeSettings();
    settings.gravity.setZero();
    Stepper stepper(settings);
    for (int k = 0; k < 4; ++k) stepper.advanceFrame(world, kDt);
    EXPECT_NEAR(world.motion[ball].velocity.y(), -0.5, 0.005);
    EXPECT_NEAR(world.motion[ball].velocity.x(), 0.5 / std::tan(angle), 0.03);
}

/// Boxes of 1 m in a row on the ground between two jaws, which close until each is `deep` in the
/// outer ones, lift them by 2 m within a second, and open after another.
struct Jaws {
    World world;
    Stepper stepper{screeSettings()};
    std::vector<BodyId> boxes;

    Jaws(int count, double deep, double friction)
    {
        const MaterialId material = addMaterial(world, friction, 0.0);
        addPlane(world, material);
        const double middle = 0.5 * (count - 1);
        for (int i = 0; i < count; ++i) {
            boxes.push_back(addBody(world, boxShape(Vec3::Ones(), 1), material,
                                    {{i - middle, 0.5, 0.0}, Quat::Identity()}));
        }
        for (const double side : {-1.0, 1.0}) {
            const auto at = [&](double apart, double y) {
                return Pose{{side * (0.5 * count + 0.1 + apart), y, 0.0}, Quat::Identity()};
            };
            addKeyedBody(world, boxShape({0.2, 1.0, 1.0}, 1), material,
                         {{0.0, at(0.2, 0.7)},
                          {0.5, at(-deep, 0.7)},
                          {1.0, at(-deep, 0.7)},
                          {2.0, at(-deep, 2.7)},
                          {3.0, at(-deep, 2.7)},
                          {3.25, at(0.2, 2.7)}},
                         KeyInterpolation::smooth);
        }
    }

    void run(int frames)
    {
        for (int f = 0; f < frames; ++f) stepper.advanceFrame(world, kDt);
    }

    /// How far above the ground, where it began.
    double lifted(BodyId box) const { return world.motion[box].position.y() - 0.5; }
};

// It lay on the ground as the jaws went up: nothing closes any more, so that no impulse was due,
// and no friction.
TEST(GapPress, JawsClosedTooFarCarryWhatIsBetweenThemUntilTheyOpen)
{
    for (const double deep : {0.002, 0.005, 0.02}) {
        Jaws jaws(1, deep, 0.5);
        const BodyId box = jaws.boxes[0];
        jaws.run(72);
        EXPECT_NEAR(jaws.lifted(box), 2.0, 5e-3) << deep;
        EXPECT_LT(jaws.world.motion[box].velocity.norm(), 5e-3) << deep;
        jaws.run(48);
        EXPECT_NEAR(jaws.lifted(box), 0.0, 5e-3) << deep;
    }
}

TEST(GapPress, JawsCarryARowThatHoldsTogetherByItself)
{
    for (const auto& [count, slips] : {std::pair{2, 0.2}, {5, 0.02}}) {  // seen: 0.15, 0.007
        Jaws jaws(count, 0.02, 0.5);
        jaws.run(72);
        for (const BodyId box : jaws.boxes) EXPECT_NEAR(jaws.lifted(box), 2.0, slips) << count;
    }
}

TEST(GapPress, JawsThatOnlyTouchOrAreSlipperyCarryNothing)
{
    for (const auto& [deep, friction] : {std::pair(0.0, 0.5), std::pair(0.02, 0.0)}) {
        Jaws jaws(1, deep, friction);
        jaws.run(72);
        EXPECT_NEAR(jaws.lifted(jaws.boxes[0]), 0.0, 5e-3) << deep << " " << friction;
    }
}

}  // namespace
}  // namespace scree::test
