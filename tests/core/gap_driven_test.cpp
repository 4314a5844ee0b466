// Method `scree` and what drives bodies: keyed motion, forces, groups, pairs of materials, births.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/dynamics/births.h"
#include "core/dynamics/gaps/sleep.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 48.0;

BodyId addKeyed(World& world, const Vec3& size, MaterialId material,
                const std::vector<MotionKey>& keys)
{
    return addKeyedBody(world, boxShape(size, 2), material, keys, KeyInterpolation::linear);
}

/// Frames of kDt, the clock moved on.
void runFrames(World& world, const StepSettings& settings, double seconds)
{
    Stepper stepper(settings);
    for (int k = 0; k < std::lround(seconds / kDt); ++k) stepper.advanceFrame(world, kDt);
}

TEST(GapKeyed, APusherDrivesABoxBeforeItWithItsOwnSpeed)  // [A54]
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.0);
    addPlane(world, material);
    const BodyId pusher = addKeyed(
        world, Vec3::Ones(), material,
        {{0.0, {{-1.5, 0.6, 0.0}, Quat::Identity()}}, {2.0, {{2.5, 0.6, 0.0}, Quat::Identity()}}});
    const BodyId box =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    runFrames(world, screeSettings(), 1.0);
    EXPECT_NEAR(world.motion[pusher].position.x(), 0.5, 1e-12);  // on its script
    // Face on face, 1 m from centre to centre. The overlap that is left alone is 1e-4 of a radius.
    EXPECT_NEAR(world.motion[box].position.x() - world.motion[pusher].position.x(), 1.0, 2e-4);
    EXPECT_NEAR(world.motion[box].velocity.x(), 2.0, 1e-3);
}

TEST(GapKeyed, ALiftCarriesABoxWithoutLagOrSinking)  // [A54]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId lift = addKeyed(
        world, {2.0, 0.2, 2.0}, material,
        {{0.0, {{0.0, -0.1, 0.0}, Quat::Identity()}}, {2.0, {{0.0, 2.9, 0.0}, Quat::Identity()}}});
    const BodyId box =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    Stepper stepper(screeSettings());
    for (int k = 0; k < 72; ++k) {
        stepper.advanceFrame(world, kDt);
        // The gap closes to zero within each step; what is left is that of the sweeps.
        ASSERT_NEAR(world.motion[box].position.y() - world.motion[lift].position.y(), 0.6, 1e-6)
            << k;
    }
}

TEST(GapKeyed, ATurntableTakesABoxRoundWithIt)  // [A54]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const double spin = 1.5;
    std::vector<MotionKey> keys;
    for (int k = 0; k <= 4; ++k) {
        keys.push_back({0.5 * k, {{0.0, -0.1, 0.0}, exponentialMap({0.0, 0.5 * k * spin, 0.0})}});
    }
    const BodyId table = addKeyed(world, {3.0, 0.2, 3.0}, material, keys);
    const Vec3 start(1.0, 0.1, 0.0);
    const BodyId box =
        addBody(world, boxShape(Vec3::Constant(0.2), 2), material, {start, Quat::Identity()}, 8.0,
                Vec3(0.0, spin, 0.0).cross(start), {0.0, spin, 0.0});
    const auto placeOnTable = [&] {
        return Vec3(inverse(world.motion[table].worldFromBody()) * world.motion[box].position);
    };
    const Vec3 before = placeOnTable();
    runFrames(world, screeSettings(), 1.0);
    // Held by friction: m w² r = 18 N of 39 N. With steps along the tangent it crept outward by
    // (w dt)²/2 of the radius each, 0.023 m in a second.
    EXPECT_LE((placeOnTable() - before).norm(), 1e-4);
    EXPECT_NEAR(world.motion[box].position.z(), -std::sin(spin), 1e-3);
}

/// A cube of 1 kg on the floor in no gravity, pressed on it by 30 N and pulled sideways.
World pressedCube(double sideways)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 1.0);
    addPlane(world, material);
    const BodyId body =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.5, 0.0}, Quat::Identity()});
    world.info[body].force = {sideways, -30.0, 0.0};
    return world;
}

StepSettings weightless()
{
    StepSettings settings = screeSettings();
    settings.gravity.setZero();
    return settings;
}

TEST(GapForces, FrictionHoldsAPressedBodyUpToCoulombsLimit)
{
    World held = pressedCube(14.0);  // friction holds 15 N
    const World before = held;
    runFrames(held, weightless(), 1.0);
    EXPECT_LE(largestVertexShift(before, held, 1), 1e-6);  // of the sweeps

    World pulled = pressedCube(20.0);
    runFrames(pulled, weightless(), 0.5);
    EXPECT_NEAR(pulled.motion[1].velocity.x(), (20.0 - 15.0) * 0.5, 1e-3);
}

TEST(GapForces, AFreeBodyUnderAForceFliesAParabolaAndATorqueSpinsItUp)  // [A56]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId body =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3::Zero(), Quat::Identity()}, 4.0);
    world.info[body].force = {8.0, 0.0, -2.0};
    world.info[body].torque = {0.0, 0.3, 0.0};
    runFrames(world, weightless(), 1.0);
    // Exact ballistics: rounding only.
    EXPECT_LE((world.motion[body].position - Vec3(1.0, 0.0, -0.25)).norm(), 1e-12);
    EXPECT_LE((world.motion[body].velocity - Vec3(2.0, 0.0, -0.5)).norm(), 1e-12);
    EXPECT_LE((world.motion[body].angularMomentum - Vec3(0.0, 0.3, 0.0)).norm(), 1e-12);
    // I = m/6 about any axis of the cube: half of 0.3 / (4/6) radians in a second.
    const Quat turned = exponentialMap({0.0, 0.5 * 0.3 * 6.0 / 4.0, 0.0});
    EXPECT_LE(world.motion[body].orientation.angularDistance(turned), 1e-7);  // acos near 1
}

TEST(GapPairs, GroupsThatDoNotCollidePassThroughEachOther)  // [A57]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    for (int i = 0; i < 2; ++i) {
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{3.0 * i, 1.0, 0.0}, Quat::Identity()});
    }
    world.traits[2].groups.group = 2;
    world.traits[2].groups.collidesWith = 2;
    runFrames(world, screeSettings(), 1.0);
    EXPECT_NEAR(world.motion[1].position.y(), 0.5, 1e-6);
    EXPECT_LT(world.motion[2].position.y(), -3.0);
}

TEST(GapPairs, WhatAnotherDoesNotMoveWakesItAndPushesItAsIfInfinitelyHeavy)  // [A57]
{
    World world;
    const MaterialId ice = addMaterial(world, 0.0, 0.0);
    addPlane(world, ice);
    const BodyId debris =
        addBody(world, boxShape(Vec3::Ones(), 2), ice, {{0.0, 0.5, 0.0}, Quat::Identity()}, 50.0);
    const BodyId hero = addBody(world, boxShape(Vec3::Ones(), 2), ice,
                                {{-4.0, 0.5, 0.0}, Quat::Identity()}, 1.0, {3.0, 0.0, 0.0});
    world.traits[debris].groups.group = 2;
    world.traits[hero].groups.unmovedBy = 2;
    runFrames(world, screeSettings(), 0.9);
    ASSERT_TRUE(world.contactMemory.isAsleep(debris));
    runFrames(world, screeSettings(), 1.0);
    EXPECT_NEAR(world.motion[hero].velocity.x(), 3.0, 1e-12);
    EXPECT_NEAR(world.motion[debris].velocity.x(), 3.0, 1e-3);
    EXPECT_NEAR(world.motion[debris].position.x() - world.motion[hero].position.x(), 1.0, 1e-3);
}

TEST(GapPairs, WhatLiesOnASleeperThatDoesNotMoveItDoesNotHarmEither)  // [A57]
{
    World world;
    const MaterialId wood = addMaterial(world, 0.5, 0.0);
    addPlane(world, wood);
    const BodyId debris =
        addBody(world, boxShape(Vec3::Ones(), 2), wood, {{0.0, 0.5, 0.0}, Quat::Identity()});
    const BodyId hero =
        addBody(world, boxShape(Vec3::Ones(), 2), wood, {{0.1, 9.0, 0.0}, Quat::Identity()});
    world.traits[debris].groups.group = 2;
    world.traits[hero].groups.unmovedBy = 2;
    runFrames(world, screeSettings(), 5.0);
    // It falls through what cannot stop it, as far as the floor, which can.
    EXPECT_NEAR(world.motion[hero].position.y(), 0.5, 1e-3);
    EXPECT_TRUE(world.motion[debris].position.allFinite());
}

// By what it does not feel it never balanced, and kept all on it awake.
TEST(GapPairs, WhatCarriesWhatDoesNotMoveItSleeps)  // [A57]
{
    World world;
    const MaterialId wood = addMaterial(world, 0.5, 0.1);
    addPlane(world, wood);
    const BodyId hero =
        addBody(world, boxShape({4.0, 1.0, 4.0}, 1), wood, {Vec3(0.0, 0.5, 0.0)}, 16.0);
    world.traits[hero].groups.unmovedBy = 2;
    for (const double x : {-1.1, 0.0, 1.1}) {
        const BodyId debris =
            addBody(world, boxShape(Vec3::Ones(), 1), wood, {Vec3(x, 1.6, 0.0)}, 1.0);
        world.traits[debris].groups.group = 2;
    }
    runFrames(world, screeSettings(), 3.0);
    for (BodyId body = hero; body < static_cast<BodyId>(world.bodyCount()); ++body)
        EXPECT_TRUE(world.contactMemory.isAsleep(body)) << body;
}

TEST(GapPairs, WhatStandsOnOneThatDoesNotMoveItDoesNotHarmIt)  // [A57]
{
    // On a pillar that holds it up and on the top of a stack that does not: of the two that touch
    // there one is unmoved, and the other is pinned while the heavier levels are solved.
    World world;
    const MaterialId wood = addMaterial(world, 0.5, 0.0);
    addPlane(world, wood);
    const auto cube = boxShape(Vec3::Ones(), 2);
    for (int i = 0; i < 3; ++i) addBody(world, cube, wood, {{0.0, 0.5 + i, 0.0}, Quat::Identity()});
    const BodyId debris =
        addBody(world, boxShape({1.0, 3.0, 1.0}, 2), wood, {{1.5, 1.5, 0.0}, Quat::Identity()});
    const BodyId hero =
        addBody(world, boxShape({2.6, 1.0, 1.0}, 2), wood, {{0.3, 3.5, 0.0}, Quat::Identity()});
    world.traits[debris].groups.group = 2;
    world.traits[hero].groups.unmovedBy = 2;
    runFrames(world, screeSettings(), 2.0);
    EXPECT_NEAR(world.motion[hero].position.y(), 3.5, 1e-3);
    EXPECT_NEAR(world.motion[debris].position.y(), 1.5, 1e-3);
}

TEST(GapPairs, AnExceptionForTwoMaterialsReplacesTheRule)  // [A27]
{
    World world;
    const MaterialId rough = addMaterial(world, 0.5, 0.0), ice = addMaterial(world, 0.5, 0.0);
    world.materialPairs.push_back({ice, rough, 0.0, std::nullopt});
    addPlane(world, rough);
    for (const MaterialId material : {rough, ice}) {
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{0.0, 0.5, 3.0 * material}, Quat::Identity()}, 1.0, Vec3::UnitX());
    }
    runFrames(world, screeSettings(), 0.5);
    EXPECT_NEAR(world.motion[1].velocity.x(), 0.0, 1e-6);
    EXPECT_NEAR(world.motion[2].velocity.x(), 1.0, 1e-6);
}

TEST(GapBirths, NothingMeetsABodyBeforeItsBirth)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    BodyDefinition later;
    later.name = "later";
    later.shape = world.addShape(boxShape(Vec3::Ones(), 2));
    later.material = material;
    later.worldFromAsset.position = {0.0, 0.5, 0.0};
    later.birth = {1000, BirthClearance::wait};
    world.addBody(later);
    const BodyId falling =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 2.0, 0.0}, Quat::Identity()});
    runFrames(world, screeSettings(), 1.0);
    EXPECT_NEAR(world.motion[falling].position.y(), 0.5, 1e-6);
}

/// Those that sleep since the start have never pressed on it.
class SleepersOnKeyed : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Since, SleepersOnKeyed, testing::Bool(), [](const auto& fromTheStart) {
    return fromTheStart.param ? "TheStart" : "TheyCameToRest";
});

TEST_P(SleepersOnKeyed, FollowASupportThatSinksOrSetsOff)  // [A54]
{
    for (const Vec3& way : {Vec3(0.0, -1.0, 0.0), Vec3(1.0, 0.0, 0.0)}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        const Pose start{{0.0, 1.9, 0.0}, Quat::Identity()};
        addKeyed(world, {2.0, 0.2, 2.0}, material,
                 {{0.0, start}, {2.0, start}, {4.0, {start.position + way, start.orientation}}});
        BodyId top = 0;
        for (const double height : {2.25, 2.75})
            top = addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                          {{0.0, height, 0.0}, Quat::Identity()});
        const World before = world;
        if (GetParam()) sleepFromTheStart(world, screeSettings(), {top - 1, top});
        runFrames(world, screeSettings(), 2.0);
        ASSERT_TRUE(world.contactMemory.isAsleep(top));
        Stepper stepper(screeSettings());
        for (int f = 0; f < 144; ++f) stepper.advanceFrame(world, kDt);
        const Vec3 moved = world.motion[top].position - before.motion[top].position;
        EXPECT_LE((moved - way).norm(), 0.01) << way.transpose();
        EXPECT_TRUE(world.contactMemory.isAsleep(top));
    }
}

TEST_P(SleepersOnKeyed, FallWhenTheirSupportIsLetGo)  // [A54]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId slab =
        addKeyed(world, {2.0, 0.2, 2.0}, material, {{0.0, {{0.0, 1.9, 0.0}, Quat::Identity()}}});
    world.info[slab].keyedUntil = 48;
    const BodyId top = addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                               {{0.0, 2.25, 0.0}, Quat::Identity()});
    if (GetParam()) sleepFromTheStart(world, screeSettings(), {top});
    runFrames(world, screeSettings(), 2.0);
    ASSERT_TRUE(world.contactMemory.isAsleep(top));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, kDt);
    EXPECT_NEAR(world.motion[top].position.y(), 0.45, 1e-3);
}

TEST(GapDriven, ABodyFallsWhenAScriptTakesItsSupportAway)  // [A55]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const Pose place{{0.0, 0.1, 0.0}, Quat::Identity()};
    const BodyId slab = addBody(world, boxShape({2.0, 0.2, 2.0}, 1), material, place);
    world.info[slab].script = std::make_shared<MotionScript>(
        std::vector<MotionKey>{{2.0, place}, {2.2, {{8.0, 0.1, 0.0}, Quat::Identity()}}},
        KeyInterpolation::linear);
    world.info[slab].keyedFrom = 48;
    const BodyId top = addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                               {{0.0, 0.45, 0.0}, Quat::Identity()});
    runFrames(world, screeSettings(), 2.0);
    EXPECT_NEAR(world.motion[top].position.y(), 0.45, 1e-3);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, kDt);
    EXPECT_NEAR(world.motion[slab].position.x(), 8.0, 1e-9);
    EXPECT_NEAR(world.motion[top].position.y(), 0.25, 1e-3);
}

}  // namespace
}  // namespace scree::test
