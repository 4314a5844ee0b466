#include "core/dynamics/step_figures.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(StepFigures, AFrameHasTheSumsOfItsStepsOrTheWorstOfThem)
{
    StepReport first, second;
    first.dt = 0.03;
    first.limitedBy = StepLimit::spin;
    first.levels = 7;
    first.largestLevel = 3;
    first.broadPairs = 40;
    first.contacts = 9;
    first.contactImpulses.sticking = 5;
    first.pushes = 2;
    first.deepestBeforePushOut = 0.2;
    first.deepestAfterPushOut = 0.1;
    first.worstOverlapRatio = 0.4;
    first.worstA = 1;
    first.worstB = 2;
    second.dt = 0.01;
    second.limitedBy = StepLimit::hover;
    second.levels = 4;
    second.largestLevel = 6;
    second.broadPairs = 30;
    second.contacts = 11;
    second.contactImpulses.sticking = 8;
    second.pushes = 1;
    second.deepestBeforePushOut = 0.05;
    second.deepestAfterPushOut = 0.3;
    second.worstOverlapRatio = 0.2;
    second.worstA = 5;
    second.worstB = 6;
    FrameReport frame;
    addStep(first, frame);
    addStep(second, frame);

    EXPECT_EQ(frame.steps, 2);
    EXPECT_EQ(frame.shortestStep, 0.01);
    EXPECT_EQ(frame.longestStep, 0.03);
    EXPECT_EQ(frame.sum.limitedBy, StepLimit::hover);
    EXPECT_DOUBLE_EQ(frame.sum.dt, 0.04);
    EXPECT_EQ(frame.sum.levels, 7);
    EXPECT_EQ(frame.sum.largestLevel, 6);
    EXPECT_EQ(frame.sum.broadPairs, 40);
    EXPECT_EQ(frame.sum.contacts, 11);
    EXPECT_EQ(frame.sum.contactImpulses.sticking, 13);
    EXPECT_EQ(frame.sum.pushes, 3);
    EXPECT_EQ(frame.sum.deepestBeforePushOut, 0.2);
    EXPECT_EQ(frame.sum.deepestAfterPushOut, 0.3);
    EXPECT_EQ(frame.sum.worstOverlapRatio, 0.4);
    EXPECT_EQ(frame.sum.worstA, 1);
    EXPECT_EQ(frame.sum.worstB, 2);
}

TEST(StepFigures, MomentaAndEnergiesAreThoseOfRigidBodiesThatAreNotFixed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId body = addBody(world, boxShape(Vec3::Ones(), 1), material,
                                {{1.0, 2.0, 0.0}, Quat::Identity()}, 3.0, {0.0, 0.0, 4.0});
    world.motion[body].angularMomentum = {0.0, 0.0, 5.0};
    const FrameReport report = reportStart(world, {0.0, -10.0, 0.0});
    EXPECT_LE((report.momentum - Vec3(0.0, 0.0, 12.0)).norm(), 1e-12);
    // r × p of the centre, and the spin.
    EXPECT_LE((report.angularMomentum - Vec3(24.0, -12.0, 5.0)).norm(), 1e-12);
    EXPECT_NEAR(report.potentialEnergy, 60.0, 1e-12);
    // A cube of edge 1: I = m/6.
    EXPECT_NEAR(report.kineticEnergy, 0.5 * 3.0 * 16.0 + 0.5 * 25.0 / (3.0 / 6.0), 1e-9);
    EXPECT_EQ(report.bodiesAwake, 1);
}

}  // namespace
}  // namespace scree::test
