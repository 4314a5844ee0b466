// Constant forces and force fields; groups; how materials combine.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/body_pairs.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 240.0;

StepSettings weightless()
{
    StepSettings settings = experimentSettings();
    settings.gravity.setZero();
    return settings;
}

void run(World& world, const StepSettings& settings, double seconds)
{
    Stepper stepper(settings);
    for (int k = 0; k < std::lround(seconds / kDt); ++k) stepper.step(world, kDt);
}

TEST(Forces, ConstantForceAndTorqueAddTheirImpulse)  // [A56]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId body =
        addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3::Zero(), Quat::Identity()}, 4.0);
    world.info[body].force = {8.0, 0.0, -2.0};
    world.info[body].torque = {0.0, 0.3, 0.0};
    run(world, weightless(), 2.0);
    // 480 additions of equal parts: rounding only.
    EXPECT_LE((world.motion[body].velocity - Vec3(4.0, 0.0, -1.0)).norm(), 1e-12);
    EXPECT_LE((world.motion[body].angularMomentum - Vec3(0.0, 0.6, 0.0)).norm(), 1e-12);
}

/// A cube of 1 kg, `gap` above the floor, pressed on it by
/// 30 N instead of gravity and pulled sideways.
World pressedCube(double sideways, double gap = 0.0)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 1.0);
    addPlane(world, material);
    const BodyId body = addBody(world, boxShape(Vec3::Ones(), 2), material,
                                {{0.0, 0.5 + gap, 0.0}, Quat::Identity()});
    world.info[body].force = {sideways, -30.0, 0.0};
    return world;
}

TEST(Forces, ABodyPressedByAForceRestsThoughItsRestitutionIsOne)  // [A56]
{
    World world = pressedCube(14.0);  // friction holds 15 N
    const World before = world;
    run(world, weightless(), 2.0);
    EXPECT_LE(largestVertexShift(before, world, 1), 1e-9);
}

TEST(Forces, WhatAForceBringsToTheFloorInOneStepIsFoundBeforeItIsThere)  // [A56]
{
    // The force takes the cube 0.5 mm in a step. Only a prediction that counts with it finds the
    // floor in time; found a step later, the cube arrives with a velocity and bounces.
    World world = pressedCube(0.0, 3e-4);
    Stepper stepper(weightless());
    for (int k = 0; k < 48; ++k) {
        stepper.step(world, kDt);
        ASSERT_LE(world.motion[1].velocity.y(), 1e-9) << k;
    }
}

TEST(Forces, ABodyPulledHarderThanFrictionHoldsSlidesAsCoulombSays)
{
    World world = pressedCube(20.0);
    run(world, weightless(), 0.5);
    // The pull tips the cube a little until its front edge carries more: 1e-4 of the speed.
    EXPECT_NEAR(world.motion[1].velocity.x(), (20.0 - 15.0) * 0.5, 1e-3);
}

TEST(Forces, WindBringsAFeatherToItsSpeedAndNeverPastIt)
{
    for (const double dt : {1.0 / 240.0, 1.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        const BodyId feather = addBody(world, boxShape({0.1, 0.01, 0.1}, 1), material,
                                       {Vec3::Zero(), Quat::Identity()}, 1e-4);
        ForceField wind;
        wind.kind = ForceField::Kind::wind;
        wind.direction = Vec3::UnitX();
        wind.strength = 7.0;
        world.fields.push_back(wind);
        Stepper stepper(weightless());
        double before = 0.0;
        for (double t = 0.0; t < 20.0; t += dt) {
            stepper.step(world, dt);
            const double v = world.motion[feather].velocity.x();
            EXPECT_GE(v, before);
            EXPECT_LE(v, 7.0);
            before = v;
        }
        EXPECT_GT(before, 6.5);
    }
}

TEST(Forces, AFallingBodyInStillAirReachesTheTerminalSpeedOfTheDragFormula)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId ball = addBody(world, buildMeshShape("ball", makeSphere(0.1, 3)), material,
                                {Vec3::Zero(), Quat::Identity()}, 0.05);
    ForceField air;
    air.kind = ForceField::Kind::wind;
    air.drag = 0.5;
    world.fields.push_back(air);
    run(world, experimentSettings(), 10.0);
    // m g = ½ ρ c A v²; the area of the mesh ball is 0.7 % below that of a true one.
    const double area = 0.25 * world.shapeOf(ball).unitMass.area;
    EXPECT_NEAR(area, kPi * 0.01, 0.01 * kPi * 0.01);
    const double terminal = std::sqrt(2.0 * 0.05 * 9.8 / (1.2 * 0.5 * area));
    // The implicit step reaches v(1 + k dt) = ... within a share k dt of the terminal speed.
    EXPECT_NEAR(-world.motion[ball].velocity.y(), terminal, 0.01 * terminal);
}

TEST(Forces, ALeafFallsAsSlowlyInOneStepAFrame)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId leaf = addBody(world, boxShape({0.1, 0.01, 0.1}, 1), material, {}, 2e-3);
    ForceField air;
    air.kind = ForceField::Kind::wind;
    air.drag = 1.0;
    world.fields.push_back(air);
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    for (int frame = 0; frame < 48; ++frame) stepper.step(world, 1.0 / 24.0);
    const double area = 0.25 * world.shapeOf(leaf).unitMass.area;
    const double terminal = std::sqrt(2.0 * 2e-3 * -settings.gravity.y() / (1.2 * area));
    EXPECT_NEAR(-world.motion[leaf].velocity.y(), terminal, 0.02 * terminal);
}

TEST(Forces, FieldsPointAndFadeAsTheySay)
{
    ForceField field;
    field.strength = 12.0;
    field.centre = {1.0, 0.0, 0.0};
    const auto at = [&](const Vec3& x, double time = 0.0) {
        return fieldAcceleration(field, time, x, Vec3::Zero(), 0.0, kDt);
    };
    EXPECT_LE((at({4.0, 4.0, 0.0}) - 12.0 * Vec3(0.6, 0.8, 0.0)).norm(), 1e-14);
    EXPECT_EQ(at(field.centre), Vec3::Zero());
    field.reach = 10.0;
    field.falloff = Falloff::linear;
    EXPECT_NEAR(at({4.0, 4.0, 0.0}).norm(), 6.0, 1e-14);
    EXPECT_EQ(at({31.0, 0.0, 0.0}), Vec3::Zero());
    field.falloff = Falloff::smooth;
    EXPECT_NEAR(at({4.0, 4.0, 0.0}).norm(), 12.0 * 0.5625, 1e-13);
    field.falloff = Falloff::inverseSquare;
    EXPECT_NEAR(at({11.0, 0.0, 0.0}).norm(), 6.0, 1e-14);
    EXPECT_NEAR(at({21.0, 0.0, 0.0}).norm(), 12.0 / (1.0 + 4.0), 1e-14);
    field.falloff = Falloff::none;
    field.kind = ForceField::Kind::vortex;
    field.direction = Vec3::UnitY();
    EXPECT_LE((at({3.0, 5.0, 0.0}) - Vec3(0.0, 0.0, -12.0)).norm(), 1e-14);
    field.kind = ForceField::Kind::uniform;
    EXPECT_EQ(at({3.0, 5.0, 7.0}), Vec3(0.0, 12.0, 0.0));
    field.kind = ForceField::Kind::vortex;
    field.keys = {{1.0, 0.0}, {3.0, 8.0}};
    EXPECT_EQ(at({3.0, 5.0, 0.0}, 0.0).norm(), 0.0);
    EXPECT_NEAR(at({3.0, 5.0, 0.0}, 2.5).norm(), 6.0, 1e-14);
    EXPECT_NEAR(at({3.0, 5.0, 0.0}, 9.0).norm(), 8.0, 1e-14);
}

TEST(Forces, WhatACentrePullsTogetherTurnsOnAboutIt)
{
    World world;
    const MaterialId material = addMaterial(world, 0.9, 0.0);
    const Vec3 spin(0.0, 1.0, 0.0);
    for (int i = 0; i < 8; ++i) {
        const Vec3 place(0.5 - (i & 1), 0.5 - (i >> 1 & 1), 0.5 - (i >> 2));
        addBody(world, boxShape(Vec3::Ones(), 1), material, {place}, 1.0, spin.cross(place), spin);
    }
    ForceField pull;
    pull.strength = -9.0;
    world.fields.push_back(pull);
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    settings.substeps.min = settings.substeps.max = 4;
    Stepper stepper(settings);
    const double before = momentaOf(world).angular.y();
    for (int f = 0; f < 96; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_NEAR(momentaOf(world).angular.y(), before, 1e-3 * before);
}

TEST(Forces, AFieldActsOnItsGroupsAlone)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    for (int i = 0; i < 3; ++i) {
        addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3(3.0 * i, 0.0, 0.0)});
        world.traits.back().groups.group = std::uint64_t{1} << i;
    }
    ForceField push;
    push.kind = ForceField::Kind::uniform;
    push.direction = Vec3::UnitZ();
    push.strength = 2.0;
    push.groups = 0b110;
    world.fields.push_back(push);
    for (const StepSettings& asked : {experimentSettings(), screeSettings()}) {
        StepSettings settings = asked;
        settings.gravity = Vec3::Zero();
        World copy = world;
        Stepper(settings).step(copy, 0.25);
        EXPECT_EQ(copy.motion[0].velocity, Vec3::Zero());
        EXPECT_EQ(copy.motion[1].velocity, Vec3(0.0, 0.0, 0.5));
        EXPECT_EQ(copy.motion[2].velocity, Vec3(0.0, 0.0, 0.5));
    }
}

/// A block thrown along +x against another that rests in its way, weightless.
World throwAt(const CollisionGroups& thrown, const CollisionGroups& target, double mass = 1.0)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.5);
    addBody(world, boxShape(Vec3::Ones(), 2), material, {{-2.0, 0.0, 0.0}, Quat::Identity()}, mass,
            {3.0, 0.0, 0.0});
    addBody(world, boxShape(Vec3::Ones(), 2), material, {Vec3::Zero(), Quat::Identity()});
    world.traits[0].groups = thrown;
    world.traits[1].groups = target;
    return world;
}

TEST(CollisionGroups, OneThatDoesNotAcceptTheOtherIsEnoughToPassThrough)  // [A57]
{
    const CollisionGroups everything{.group = 2}, choosy{.group = 4, .collidesWith = 1};
    World met = throwAt(everything, everything), passed = throwAt(everything, choosy);
    run(met, weightless(), 1.0);
    run(passed, weightless(), 1.0);
    EXPECT_GT(met.motion[1].velocity.x(), 1.0);
    EXPECT_EQ(passed.motion[1].velocity, Vec3::Zero());
    EXPECT_EQ(passed.motion[0].velocity, Vec3(3.0, 0.0, 0.0));
}

TEST(CollisionGroups, ABodyUnmovedByAnotherPushesItAsIfInfinitelyHeavy)  // [A57]
{
    const CollisionGroups hero{.group = 2, .unmovedBy = 4}, debris{.group = 4};
    World world = throwAt(hero, debris);
    run(world, weightless(), 1.0);
    EXPECT_EQ(world.motion[0].velocity, Vec3(3.0, 0.0, 0.0));
    // Thrown by 10⁹ kg without groups it differs by the share that those give way, 1e-9 or so.
    World heavy = throwAt({}, {}, 1e9);
    run(heavy, weightless(), 1.0);
    EXPECT_GT(world.motion[1].velocity.x(), 3.0);
    EXPECT_NEAR(world.motion[1].velocity.x(), heavy.motion[1].velocity.x(), 1e-6);
}

TEST(CollisionGroups, TwoUnmovedByEachOtherPassThrough)  // [A57]
{
    const CollisionGroups one{.group = 2, .unmovedBy = 4}, other{.group = 4, .unmovedBy = 2};
    World world = throwAt(one, other);
    run(world, weightless(), 1.0);
    EXPECT_EQ(world.motion[1].velocity, Vec3::Zero());
}

/// Speed after half a second of a block on a 30° slope, of a material without friction on a rough
/// one.
double speedOnSlope(CombineRule rule, std::optional<double> pairFriction = {})
{
    World world;
    const MaterialId rough = addMaterial(world, 0.8, 0.0), smooth = addMaterial(world, 0.0, 0.0);
    const Quat tilt = exponentialMap({0.0, 0.0, kPi / 6.0});
    addPlane(world, rough, Vec3::Zero(), tilt * Vec3::UnitY());
    addBody(world, boxShape(Vec3::Ones(), 2), smooth, {tilt * Vec3(0.0, 0.5, 0.0), tilt});
    if (pairFriction) world.materialPairs.push_back({smooth, rough, pairFriction, {}});
    StepSettings settings = experimentSettings();
    settings.frictionRule = rule;
    run(world, settings, 0.5);
    return world.motion[1].velocity.norm();
}

TEST(CombineRules, DecideWhetherASlipperyBodySlidesOnARoughSlope)  // [A27]
{
    const double free = 9.8 * 0.5 * 0.5;
    EXPECT_NEAR(speedOnSlope(CombineRule::maximum), 0.0, 1e-9);
    EXPECT_NEAR(speedOnSlope(CombineRule::minimum), free, 1e-4);
    EXPECT_NEAR(speedOnSlope(CombineRule::multiply), free, 1e-4);
    EXPECT_NEAR(speedOnSlope(CombineRule::geometric), free, 1e-4);
    EXPECT_NEAR(speedOnSlope(CombineRule::mean), 0.5 * 9.8 * (0.5 - 0.4 * std::sqrt(0.75)), 1e-4);
    EXPECT_NEAR(speedOnSlope(CombineRule::maximum, 0.0), free, 1e-4);
    EXPECT_NEAR(speedOnSlope(CombineRule::minimum, 0.7), 0.0, 1e-9);
}

TEST(CombineRules, AnExceptionForTwoMaterialsReplacesWhatItSaysAndNoMore)  // [A27]
{
    World world;
    const MaterialId first = addMaterial(world, 0.2, 0.1), second = addMaterial(world, 0.4, 0.3);
    for (const MaterialId material : {first, second})
        addBody(world, boxShape(Vec3::Ones(), 1), material, {});
    const StepSettings settings;  // the larger friction, the smaller restitution
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).friction, 0.4);
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).restitution, 0.1);
    world.materialPairs = {{second, first, {}, 0.9}};
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).friction, 0.4);
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).restitution, 0.9);
    world.materialPairs = {{first, second, 0.7, {}}};
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).friction, 0.7);
    EXPECT_EQ(surfaceOf(world, settings, {0, 1}).restitution, 0.1);
}

TEST(Forces, WhatSwingsThroughAPointOfAttractionSwingsNoFarther)  // [A56]
{
    for (const Method method : {Method::paper, Method::scree}) {
        StepSettings settings = weightless();
        settings.method = method;
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        ForceField field;
        field.strength = -10.0;
        world.fields.push_back(field);
        const BodyId body = addBody(world, exactSphere(0.1), material,
                                    {{2.0, 0.0, 0.0}, Quat::Identity()}, 1.0, {0.0, 0.0, 3.0});
        Stepper stepper(settings);
        double farthest = 0.0;
        for (int f = 0; f < 480; ++f) {
            stepper.advanceFrame(world, 1.0 / 24.0);
            farthest = std::max(farthest, world.motion[body].position.norm());
        }
        EXPECT_NEAR(farthest, 2.0, 0.08) << (method == Method::paper ? "paper" : "scree");
    }
}

}  // namespace
}  // namespace scree::test
