// E11: push-out separates what overlaps, moves only what may move, and touches no velocity.  [A52]
#include <gtest/gtest.h>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(E11PushOut, TwoFreeCubesPartAboutTheirCommonCentre)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addBody(world, boxShape(Vec3::Ones(), 2), material, {Vec3::Zero(), Quat::Identity()});
    addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.9, 0.0}, Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.gravity.setZero();
    const World before = world;
    Stepper stepper(settings);
    StepReport report;
    for (int k = 0; k < 10; ++k) report = stepper.step(world, 1.0 / 240.0);
    EXPECT_LE(report.deepestAfterPushOut, 1e-3);
    EXPECT_LE(world.motion[1].position.y() - world.motion[0].position.y() - 1.0, 1e-3);
    const Vec3 centre = world.motion[0].position + world.motion[1].position;
    EXPECT_LE((centre - Vec3(0.0, 0.9, 0.0)).norm(), 1e-12);
    for (int b = 0; b < 2; ++b) {
        EXPECT_EQ(world.motion[b].velocity, before.motion[b].velocity);
        EXPECT_EQ(world.motion[b].angularMomentum, before.motion[b].angularMomentum);
    }
}

World overlappingColumn()
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < 5; ++i) {
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{0.0, 0.48 + 0.98 * i, 0.0}, Quat::Identity()});
    }
    return world;
}

TEST(E11PushOut, AColumnOfOverlappingCubesComesApartFromBelowInOneStep)
{
    World world = overlappingColumn();
    Stepper stepper(experimentSettings());
    EXPECT_LE(stepper.step(world, 1.0 / 240.0).deepestAfterPushOut, 0.01);
    for (int b = 1; b <= 5; ++b) {
        EXPECT_NEAR(world.motion[b].position.y(), b - 0.5, 0.01) << "cube " << b;
    }
    StepReport report;
    for (int k = 0; k < 9; ++k) report = stepper.step(world, 1.0 / 240.0);
    EXPECT_LE(report.deepestAfterPushOut, 1e-3);
}

TEST(E11PushOut, TheFloorDoesNotGiveWay)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    const BodyId floor = addPlane(world, material);
    const BodyId cube =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.4, 0.0}, Quat::Identity()});
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 10; ++k) stepper.step(world, 1.0 / 240.0);
    EXPECT_TRUE(world.motion[floor].position.isZero());
    EXPECT_NEAR(world.motion[cube].position.y(), 0.5, 1e-3);
    EXPECT_LE(world.motion[cube].velocity.norm(), 1e-9);
}

TEST(E11PushOut, ACubeBetweenTwoWallsTooCloseIsNotThrownAbout)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material, {-0.4, 0.0, 0.0}, Vec3::UnitX());
    addPlane(world, material, {0.4, 0.0, 0.0}, -Vec3::UnitX());
    const BodyId cube =
        addBody(world, boxShape(Vec3::Ones(), 2), material, {Vec3::Zero(), Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.gravity.setZero();
    Stepper stepper(settings);
    std::int64_t pushes = 0;
    for (int k = 0; k < 20; ++k) {
        const Vec3 before = world.motion[cube].position;
        pushes += stepper.step(world, 1.0 / 240.0).pushes;
        EXPECT_LE((world.motion[cube].position - before).norm(), 0.5);
        EXPECT_LE(std::abs(world.motion[cube].position.x()), 0.2);
    }
    EXPECT_GT(pushes, 0);
    EXPECT_LE(world.motion[cube].velocity.norm(), 1e-12);
}

TEST(E11PushOut, SwitchedOffItLeavesEveryPositionAlone)
{
    World pushed = overlappingColumn(), left = overlappingColumn();
    StepSettings settings = experimentSettings();
    Stepper(settings).step(pushed, 1.0 / 240.0);
    settings.pushOut = false;
    const StepReport report = Stepper(settings).step(left, 1.0 / 240.0);
    EXPECT_EQ(report.pushes, 0);
    EXPECT_EQ(report.deepestBeforePushOut, report.deepestAfterPushOut);
    for (int b = 1; b <= 5; ++b) EXPECT_EQ(left.motion[b].velocity, pushed.motion[b].velocity);
}

}  // namespace
}  // namespace scree::test
