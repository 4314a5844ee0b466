// Push-out of method `scree`: what begins inside each other comes apart at once and from below;
// what steps leave, bit by bit. Experiment E11 has the paper's cases.  [A52]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kStep = 1.0 / 240.0;

/// Five cubes, the lowest 2 cm in the floor and every other 2 cm in the one below.
World makeSunkenColumn(double topMass)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < 5; ++i) {
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(0.0, 0.48 + 0.98 * i, 0.0), Quat::Identity()}, i == 4 ? topMass : 1.0);
    }
    return world;
}

TEST(GapPushOut, AColumnSunkenIntoItselfRisesFromTheFloorInOneStepWhateverItsTopWeighs)
{
    for (const double topMass : {1.0, 1000.0}) {
        World world = makeSunkenColumn(topMass);
        Stepper stepper(screeSettings());
        const StepReport report = stepper.step(world, kStep);
        // A twentieth of each 2 cm gives way in the last of four pushes; seen 4 mm and 3 mm.
        for (int i = 0; i < 5; ++i) EXPECT_NEAR(world.motion[i + 1].position.y(), i + 0.5, 0.01);
        EXPECT_LE(report.deepestAfterPushOut, 0.005);
        EXPECT_NEAR(report.deepestBeforePushOut, 0.02, 1e-9);
    }
}

/// Twenty bricks, each hardly deep in the next: the top one is to rise by 35 mm, and nobody looks
/// so far.
TEST(GapPushOut, AColumnThatRisesDoesNotGoThroughWhatLiesAhead)
{
    constexpr double kDeep = 1.8e-3, kAhead = 0.02, kThickness = 0.02;
    constexpr int kBricks = 20;
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    for (int i = 0; i < kBricks; ++i) {
        addBody(world, boxShape({0.25, 0.1, 0.12}, 1), material,
                {Vec3(0.0, 0.05 - kDeep + (0.1 - kDeep) * i, 0.0), Quat::Identity()});
    }
    const BodyId top = kBricks;
    const double ceiling = world.motion[top].position.y() + 0.05 + kAhead;
    addBody(world, boxShape({0.3, kThickness, 0.3}, 1), material,
            {Vec3(0.0, ceiling + 0.5 * kThickness, 0.0), Quat::Identity()}, 100.0);
    Stepper stepper(screeSettings());
    for (int n = 0; n < 30; ++n) {
        const StepReport report = stepper.step(world, 1.0 / 960.0);
        const double lid = world.motion[top + 1].position.y() - 0.5 * kThickness;
        EXPECT_LE(world.motion[top].position.y() + 0.05 - lid, kDeep) << n;
        EXPECT_LE(report.deepestAfterPushOut, 1.5 * kDeep) << n;
    }
}

TEST(GapPushOut, WhatPartsKeepsItsCommonCentreItsVelocityAndItsOrientation)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    const Vec3 drift(0.3, 0.0, 0.1);
    addBody(world, exactSphere(0.5), material, {Vec3::Zero(), Quat::Identity()}, 1.0, drift);
    addBody(world, exactSphere(0.5), material, {Vec3(0.0, 0.8, 0.0), Quat::Identity()}, 3.0, drift);
    Stepper stepper(settings);
    stepper.step(world, kStep);
    const Vec3 apart = world.motion[1].position - world.motion[0].position;
    EXPECT_NEAR(apart.norm(), 1.0, 5e-3);
    const Vec3 centre = 0.25 * world.motion[0].position + 0.75 * world.motion[1].position;
    EXPECT_LE((centre - Vec3(0.0, 0.6, 0.0) - kStep * drift).norm(), 1e-15);
    for (const BodyMotion& motion : world.motion) EXPECT_EQ(motion.velocity, drift);
}

TEST(GapPushOut, WhatStepsLeaveIsTakenAwayBitByBit)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
            {Vec3(0.0, 0.498, 0.0), Quat::Identity()});
    Stepper stepper(screeSettings());
    stepper.step(world, kStep);
    // A fifth of 2 mm without the slop. All of it at once shook stacks.
    EXPECT_NEAR(world.motion[1].position.y(), 0.498 + 0.2 * (0.002 - 8.7e-5), 1e-5);
}

// What is wedged in a chimney sank as much as it was lifted, and went somewhere on that, until the
// chimney fell.
TEST(GapPushOut, WhatHasStayedInItsPlaceForLongIsLeftAShareOfItsThickness)
{
    const auto risenAfter = [](double units) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.3);
        addPlane(world, material);
        const Stay here{Vec3(0.0, 0.498, 0.0), Quat::Identity(), 0};
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material, {here.position, here.orientation});
        world.frameDuration = 1.0 / 24.0;
        world.contactMemory.rest.assign(2, {here, here, here});
        const double unit = std::sqrt(0.5 * std::sqrt(3.0) / 9.81);
        world.contactMemory.rest[1].around.frames =
            static_cast<std::int32_t>(std::lround(units * unit / world.frameDuration));
        Stepper stepper(screeSettings());
        stepper.step(world, kStep);
        return world.motion[1].position.y() - here.position.y();
    };
    EXPECT_NEAR(risenAfter(12.0), 0.2 * (0.002 - 8.7e-5), 1e-6);
    // Halfway from the slop to 4 mm it is less than at first, and then nothing.
    EXPECT_NEAR(risenAfter(20.0), 0.2 * (0.002 - 1.06e-3), 2e-5);
    EXPECT_NEAR(risenAfter(24.0), 0.0, 1e-15);
    EXPECT_NEAR(risenAfter(48.0), 0.0, 1e-15);
}

// The upper cube was not asked: it was pushed into, and lifted out again in the steps to come.
TEST(GapPushOut, WhatIsPushedOutOfOneIsNotPushedIntoAnother)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (const double height : {0.497, 1.497}) {
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(0.0, height, 0.0), Quat::Identity()});
    }
    Stepper stepper(screeSettings());
    stepper.step(world, kStep);
    // Up to the slop; the fifth of 3 mm that the lower one rises by is 0.58 mm.
    const double lower = world.motion[1].position.y(), upper = world.motion[2].position.y();
    EXPECT_GE(upper - lower, 1.0 - 1.5e-4);
    EXPECT_GE(lower, 0.497 + 4e-4);
}

// Handed on by halves a push of 0.58 mm came to nothing on the way up: the upper half was not
// lifted at all, and the lower ones were pressed into it.
TEST(GapPushOut, WhatLiftsTheLowestOfAColumnLiftsAll)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    constexpr double kApart = 1.0 - 8.6e-5;  // as deep in each other as they may stay
    for (int i = 0; i < 10; ++i) {
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(0.0, 0.497 + kApart * i, 0.0), Quat::Identity()});
    }
    world.frameDuration = kStep;
    world.contactMemory.rest.assign(world.bodyCount(), {});
    for (BodyRest& rest : world.contactMemory.rest) rest.nearby.frames = 1000;  // it settles
    Stepper stepper(screeSettings());
    stepper.step(world, kStep);
    for (int i = 0; i < 10; ++i)
        EXPECT_NEAR(world.motion[i + 1].position.y() - kApart * i, 0.49758, 1.2e-4) << i;
}

/// A hundred and ninety dominoes along a spiral [m], the outermost about to tip over.
World makeSpiral()
{
    constexpr double kApart = 0.021, kBetween = 0.05;
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.1);
    addPlane(world, material);
    const auto domino = boxShape({0.0075, 0.048, 0.024}, 1);
    double angle = 0.0;
    for (int i = 0; i < 190; ++i) {
        const double radius = 0.26 - kBetween * angle / (2.0 * kPi);
        const Vec3 place(radius * std::cos(angle), 0.024, radius * std::sin(angle));
        const Quat heading(Eigen::AngleAxisd(-angle - 0.5 * kPi, Vec3::UnitY()));
        addBody(world, domino, material, {place, heading}, 0.0104,
                i == 0 ? Vec3(0.0, 0.0, 0.2) : Vec3::Zero(),
                i == 0 ? Vec3(8.0, 0.0, 0.0) : Vec3::Zero());
        angle += kApart / radius;
    }
    return world;
}

/// The deepest overlap after some of a row of fallen dominoes were pressed into the ground [m].
double deepestOfPressedDominoes(double gravity)
{
    World world = makeSpiral();
    StepSettings settings = screeSettings();
    settings.gravity *= gravity;
    Stepper stepper(settings);
    for (int frame = 0; frame < 120; ++frame) stepper.advanceFrame(world, 1.0 / 24.0);
    for (std::size_t i = 30; i < world.bodyCount(); i += 30) world.motion[i].position.y() -= 3e-4;
    double worst = 0.0;
    for (int step = 0; step < 100; ++step)
        worst = std::max(worst, stepper.step(world, 1.0 / 192.0).deepestBeforePushOut);
    for (std::size_t i = 1; i < world.bodyCount(); ++i)
        EXPECT_LE(world.motion[i].position.y(), 0.02) << "domino " << i << " does not lie";
    return worst;
}

TEST(GapPushOut, AFallenRowOfDominoesIsNotThrownAboutByAnOverlapThatIsHardlyDeep)
{
    // A third of a millimetre is deep for bodies as thin: the push grew by levers from domino to
    // domino, to 2 mm; 0.3 to 0.8 mm now. One row in eight happens to lie so that it is 1.5 mm.
    std::array<double, 3> worst;
    for (std::size_t i = 0; i < worst.size(); ++i)
        worst[i] = deepestOfPressedDominoes(1.0 + 1e-5 * static_cast<double>(i));
    std::sort(worst.begin(), worst.end());
    EXPECT_LE(worst[1], 1e-3);
}

// Each leans on the next by a five hundredth, and was to rest on it: the "highest", as the easiest
// to push, went back into the wall from where all the others have room to go.
TEST(GapPushOut, BooksThatLeanAwayFromAWallAreNotPushedIntoIt)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addPlane(world, material, Vec3::Zero(), Vec3::UnitX());
    constexpr double kThick = 0.04, kDeep = 5e-4;
    const Quat leaning(Eigen::AngleAxisd(-0.002, Vec3::UnitZ()));
    for (int i = 0; i < 26; ++i) {
        const double x = 0.5 * kThick + i * (kThick - kDeep);
        addBody(world, boxShape({kThick, 0.35, 0.24}, 1), material, {{x, 0.175, 0.0}, leaning});
    }
    Stepper stepper(screeSettings());
    double worst = 0.0;
    for (int step = 0; step < 400; ++step)
        worst = std::max(worst, stepper.step(world, 1.0 / 192.0).deepestBeforePushOut);
    EXPECT_LE(worst, 2e-3);  // seen: 1.0 mm, and 9.4
    EXPECT_GE(world.motion[27].position.x(), 0.5 * kThick + 25 * (kThick - kDeep) + 3e-3);
}

TEST(GapPushOut, WhatIsSqueezedBetweenWallsTooCloseStaysInTheMiddle)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material, Vec3(-0.4, 0.0, 0.0), Vec3::UnitX());
    addPlane(world, material, Vec3(0.4, 0.0, 0.0), -Vec3::UnitX());
    addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material, {Vec3::Zero(), Quat::Identity()});
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    Stepper stepper(settings);
    for (int i = 0; i < 20; ++i) stepper.step(world, kStep);
    // Pushes that never give way would leave it at whichever wall was asked last, 10 cm aside.
    EXPECT_LE(world.motion[2].position.norm(), 1e-3);
    EXPECT_LE(world.motion[2].orientation.vec().norm(), 1e-3);
}

/// Two of a shape, one turned by a little, begin `offset` apart on the ground: how far apart their
/// centres are after 2 s, and how fast any of the two has been.
std::array<double, 2> comeApart(const std::shared_ptr<const Shape>& shape, double height,
                                double offset, double turn)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addBody(world, shape, material, {Vec3(0.0, height, 0.0), Quat::Identity()});
    addBody(world, shape, material,
            {Vec3(offset, height, 0.01), exponentialMap(Vec3(0.0, turn, 0.0))});
    Stepper stepper(screeSettings());
    double fastest = 0.0;
    for (int i = 0; i < 192; ++i) {
        stepper.step(world, 1.0 / 96.0);
        for (const BodyMotion& motion : world.motion)
            fastest = std::max(fastest, motion.velocity.norm());
    }
    return {(world.motion[1].position - world.motion[2].position).norm(), fastest};
}

// Once the middle of one was past that of the other they were drawn into one place, and slept
// there; boxes deeper than a quarter of their size stayed where they were.
TEST(GapPushOut, WhatBeginsInThePlaceOfAnotherComesOutOfIt)
{
    const auto ball = buildMeshShape("ball", makeSphere(0.5, 3));
    const auto box = boxShape({1.0, 1.0, 1.0}, 2);
    for (const double offset : {0.8, 0.6, 0.4, 0.2, 0.0}) {
        for (const double turn : {0.0, 0.3}) {
            const auto [balls, fastestBall] = comeApart(ball, 0.5, offset, turn);
            EXPECT_GE(balls, 0.999) << offset;
            EXPECT_LE(fastestBall, 4.5) << offset;  // a fall from on top of the other
            const auto [boxes, fastestBox] = comeApart(box, 0.5, offset, turn);
            EXPECT_GE(boxes, 0.999) << offset;
            EXPECT_LE(fastestBox, 4.5) << offset;
        }
    }
}

TEST(GapPushOut, WhatBeginsInsideSomethingLargeComesOutOfItsNearestFace)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId large = addBody(world, boxShape({4.0, 1.0, 4.0}, 2), material,
                                 {Vec3(0.0, 0.5, 0.0), Quat::Identity()}, 1000.0);
    const BodyId small = addBody(world, boxShape({0.2, 0.2, 0.2}, 1), material,
                                 {Vec3(0.3, 0.7, 0.1), Quat::Identity()}, 1.0);
    Stepper stepper(screeSettings());
    for (int i = 0; i < 96; ++i) stepper.step(world, 1.0 / 96.0);
    EXPECT_NEAR(world.motion[small].position.y(), 1.1, 1e-3);
    EXPECT_NEAR(world.motion[large].position.y(), 0.5, 1e-3);
}

/// One of its corners is past the middle of the plate, and led out above.
TEST(GapPushOut, ACubePressedPartlyIntoAPlateFallsFromUnderIt)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addBody(world, boxShape({4.0, 0.2, 4.0}, 8), material, {{0.0, 1.2, 0.0}, Quat::Identity()},
            0.0);
    const BodyId cube =
        addBody(world, boxShape(Vec3::Constant(0.2), 1), material,
                {{0.16, 1.057, -0.155}, Quat(0.707, 0.076, 0.547, -0.442).normalized()});
    Stepper stepper(screeSettings());
    for (int k = 0; k < 48; ++k) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_LT(world.motion[cube].position.y(), 0.2);
}

}  // namespace
}  // namespace scree::test
