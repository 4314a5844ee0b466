// What is a ball, and what is round about which axis.
#include "core/geometry/revolution.h"

#include <gtest/gtest.h>

#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"

namespace scree {
namespace {

TEST(Revolution, WhatIsMadeRoundAboutAnAxisIsWhereItsFacetsAreFine)
{
    // They are made round about y.
    const Vec3 aboutY(1.0, 0.0, 1.0), none = Vec3::Ones();
    EXPECT_EQ(turnsThatShow(makeCylinder(0.5, 0.3, 18, 1)), aboutY);
    EXPECT_EQ(turnsThatShow(makeCylinder(0.5, 0.3, 17, 1)), none);
    EXPECT_EQ(turnsThatShow(makeTorus(1.0, 0.25, {18, 4})), aboutY);
    EXPECT_EQ(turnsThatShow(makeTorus(1.0, 0.25, {16, 10})), none);
    EXPECT_EQ(turnsThatShow(makeCapsule(0.2, 1.0, 20, 5)), aboutY);
    EXPECT_EQ(turnsThatShow(makeBox({1.0, 1.0, 1.0}, {4, 4, 4})), none);
    EXPECT_EQ(turnsThatShow(makeSphere(0.5, 3)), Vec3(Vec3::Zero()));
    EXPECT_EQ(turnsThatShow(makeSphere(0.5, 1)), none);
}

// Of the tip of a screw, 1e-19 m from its axis, it was said that turns about that move it.
TEST(Revolution, ATipIsOnTheAxisAsFarAsFilesTell)
{
    TriMesh pencil = makeCylinder(0.1, 1.0, 24, 1);
    Eigen::Index tip = 0;
    const double nearest = pencil.points.topRows(1).cwiseAbs2().row(0).minCoeff(&tip);
    ASSERT_EQ(nearest, 0.0);
    pencil.points.col(tip) *= 1.4;
    pencil.points.col(tip).x() = 1e-9;
    EXPECT_EQ(turnsThatShow(pencil), Vec3(1.0, 0.0, 1.0));
    pencil.points.col(tip).x() = 1e-3;
    EXPECT_EQ(turnsThatShow(pencil), Vec3(Vec3::Ones()));
}

TEST(Revolution, AHandleShows)
{
    TriMesh mug = makeCylinder(0.5, 1.0, 48, 4);
    for (Eigen::Index v = 0; v < mug.points.cols(); ++v) {
        if (mug.points.col(v).x() > 0.49) mug.points.col(v).x() = 0.7;
    }
    EXPECT_EQ(turnsThatShow(mug), Vec3(Vec3::Ones()));
}

TEST(Revolution, AFineMeshAllOfWhosePointsAreAsFarAwayIsABall)
{
    const auto ballOf = [](const TriMesh& mesh) {
        const auto shape = buildMeshShape("it", mesh);
        return shape->isBall() ? shape->capsule.radius : 0.0;
    };
    EXPECT_NEAR(ballOf(makeSphere(0.5, 3)), 0.5, 1e-6);
    EXPECT_NEAR(ballOf(makeSphere(0.5, 2)), 0.5, 1e-6);
    EXPECT_EQ(ballOf(makeSphere(0.5, 1)), 0.0);
    EXPECT_EQ(ballOf(makeCapsule(0.5, 1e-3, 48, 12)), 0.0);
    EXPECT_EQ(ballOf(makeCylinder(0.5, 1.0, 48, 4)), 0.0);
    TriMesh egg = makeSphere(0.5, 3);
    egg.points.row(1) *= 1.001;
    EXPECT_EQ(ballOf(egg), 0.0);
}

TEST(Revolution, AFineMeshAllOfWhosePointsAreAsFarFromASegmentIsACapsule)
{
    const auto capsuleOf = [](const TriMesh& mesh) { return buildMeshShape("it", mesh)->capsule; };
    // Wherever it stands, and with the digits that a file has.
    TriMesh mesh = makeCapsule(0.2, 1.0, 20, 5);
    const Pose askew{{1.0, -2.0, 0.5}, Quat(0.5, 0.1, -0.7, 0.3).normalized()};
    mesh = transformed(mesh, askew);
    mesh.points = (1e5 * mesh.points).array().round().matrix() / 1e5;
    const Capsule capsule = capsuleOf(mesh);
    EXPECT_NEAR(capsule.radius, 0.2, 1e-5);
    EXPECT_NEAR(capsule.half.norm(), 0.5, 1e-5);
    EXPECT_EQ(capsuleOf(makeSphere(0.5, 3)).half, Vec3(Vec3::Zero()));
    EXPECT_NEAR(capsuleOf(makeCapsule(0.2, 1.0, 18, 5)).radius, 0.2, 1e-6);
    // Too few sides, too few bands, no round ends, one end blown up.
    EXPECT_EQ(capsuleOf(makeCapsule(0.2, 1.0, 17, 5)).radius, 0.0);
    EXPECT_EQ(capsuleOf(makeCapsule(0.2, 1.0, 20, 4)).radius, 0.0);
    EXPECT_EQ(capsuleOf(makeCylinder(0.2, 1.0, 32, 4)).radius, 0.0);
    TriMesh club = makeCapsule(0.2, 1.0, 32, 8);
    for (Eigen::Index v = 0; v < club.points.cols(); ++v) {
        if (club.points(1, v) > 0.0) club.points.col(v).x() *= 1.001;
    }
    EXPECT_EQ(capsuleOf(club).radius, 0.0);
}

}  // namespace
}  // namespace scree
