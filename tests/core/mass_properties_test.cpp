// E10: mass properties against closed forms.  [A1–A3]
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/geometry/mass_properties.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

TEST(E10MassProperties, ABoxMatchesItsClosedForm)
{
    const MassProperties box = massProperties(makeBox({0.2, 0.4, 0.8}, {1, 2, 3}));
    const double mass = 0.064;
    EXPECT_NEAR(box.volume, mass, 1e-13 * mass);
    EXPECT_LE(box.centre.norm(), 1e-15);
    // Ascending: about z (0.2² + 0.4²), about y, about x.
    const Vec3 expected = mass / 12.0 * Vec3(0.2, 0.68, 0.8);
    EXPECT_LE((box.moments - expected).norm(), 1e-13 * expected.norm());
}

TEST(E10MassProperties, ATetrahedronMatchesItsClosedForm)
{
    TriMesh mesh;
    mesh.points.resize(3, 4);
    mesh.points << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
    const MassProperties tetrahedron = massProperties(mesh);
    EXPECT_NEAR(tetrahedron.volume, 1.0 / 6.0, 1e-15);
    EXPECT_LE((tetrahedron.centre - Vec3::Constant(0.25)).norm(), 1e-15);
    // C = V/80 (1 − …): diagonal 3/80 V, off-diagonal −1/80 V; eigenvalues of tr(C) − C.
    const double v = 1.0 / 6.0;
    EXPECT_NEAR(tetrahedron.moments[0], v * (9.0 - 4.0) / 80.0 + 0.0, 1e-15);
    EXPECT_NEAR(tetrahedron.moments[2], v * (9.0 - 1.0) / 80.0, 1e-15);
}

TEST(E10MassProperties, FarFromTheOriginNothingIsLost)
{
    const TriMesh box = makeBox({1.0, 2.0, 3.0}, {1, 1, 1});
    const Vec3 far(1e6, -1e6, 1e6);
    const MassProperties here = massProperties(box);
    const MassProperties there = massProperties(transformed(box, {far, Quat::Identity()}));
    EXPECT_NEAR(there.volume, here.volume, 1e-9 * here.volume);
    EXPECT_LE((there.centre - far).norm(), 1e-9 * far.norm());
    EXPECT_LE((there.moments - here.moments).norm(), 1e-9 * here.moments.norm());
}

TEST(E10MassProperties, TurningAMeshTurnsItsAxesAndNothingElse)
{
    const TriMesh box = makeBox({1.0, 2.0, 3.0}, {1, 1, 1});
    const MassProperties before = massProperties(box);
    for (const Vec3& turn : {Vec3(0.3, -1.1, 0.7), Vec3(2.0, 0.1, -0.4), Vec3(-0.9, 0.8, 1.9)}) {
        const Quat rotation = exponentialMap(turn);
        const MassProperties after = massProperties(transformed(box, {Vec3(1, 2, 3), rotation}));
        EXPECT_LE((after.moments - before.moments).norm(), 1e-12 * before.moments.norm());
        for (int k = 0; k < 3; ++k) {
            const Vec3 expected = rotation * (before.meshFromPrincipal * Vec3::Unit(k));
            const Vec3 axis = after.meshFromPrincipal * Vec3::Unit(k);
            EXPECT_NEAR(std::abs(axis.dot(expected)), 1.0, 1e-12);
        }
    }
}

TEST(E10MassProperties, ASolidWithACavityWeighsLess)
{
    // The cavity's triangles are turned round: outward from the material.
    const TriMesh outer = makeBox({2.0, 2.0, 2.0}, {1, 1, 1});
    TriMesh inner = makeBox({1.0, 1.0, 1.0}, {1, 1, 1});
    inner.triangles.row(1).swap(inner.triangles.row(2));
    TriMesh both;
    both.points.resize(3, outer.points.cols() + inner.points.cols());
    both.points << outer.points, inner.points;
    both.triangles.resize(3, outer.triangles.cols() + inner.triangles.cols());
    both.triangles << outer.triangles,
        (inner.triangles.array() + static_cast<int>(outer.points.cols())).matrix();
    const MassProperties hollow = massProperties(both);
    EXPECT_NEAR(hollow.volume, 7.0, 1e-13 * 7.0);
    EXPECT_NEAR(hollow.moments[0], (8.0 * 8.0 - 1.0 * 2.0) / 12.0, 1e-12);
    EXPECT_TRUE(findDefects(both).empty());
}

/// Relative error of the first moment (about the axis) and of the volume.
Vec3 torusError(int refinement)
{
    const double major = 1.0, minor = 0.25;
    const MassProperties torus =
        massProperties(makeTorus(major, minor, {16 * refinement, 10 * refinement}));
    const double volume = 2.0 * kPi * kPi * major * minor * minor;
    const double axial = volume * (major * major + 0.75 * minor * minor);
    const double across = volume * (0.5 * major * major + 0.625 * minor * minor);
    return {torus.volume / volume - 1.0, torus.moments[2] / axial - 1.0,
            torus.moments[0] / across - 1.0};
}

TEST(E10MassProperties, RoundShapesConvergeWithTheSquareOfTheResolution)
{
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(torusError(4)[k] / torusError(8)[k], 4.0, 0.4) << "quantity " << k;
    }
    const auto sphereError = [](int subdivisions) {
        return massProperties(makeSphere(1.0, subdivisions)).volume / (4.0 / 3.0 * kPi) - 1.0;
    };
    EXPECT_NEAR(sphereError(3) / sphereError(4), 4.0, 0.4);
    const auto cylinderError = [](int sectors) {
        return massProperties(makeCylinder(0.5, 2.0, sectors, 1)).moments[0] /
                   (0.25 * kPi * 2.0 * 0.25 * 0.25 * 2.0) -
               1.0;
    };
    EXPECT_NEAR(cylinderError(32) / cylinderError(64), 4.0, 0.4);
}

TEST(E10MassProperties, EqualMomentsLeaveTheArtistsAxesAlone)
{
    const auto isIdentity = [](const Quat& q) { return q.vec().norm() < 1e-12; };
    EXPECT_TRUE(isIdentity(massProperties(makeBox(Vec3::Ones(), {2, 2, 2})).meshFromPrincipal));
    EXPECT_TRUE(isIdentity(massProperties(makeSphere(1.0, 2)).meshFromPrincipal));
    // The torus is round about y: its axis goes last, the other two stay along the artist's.
    const Mat3 axes =
        massProperties(makeTorus(1.0, 0.25, {16, 10})).meshFromPrincipal.toRotationMatrix();
    EXPECT_LE((axes.cwiseAbs().colwise().maxCoeff().array() - 1.0).abs().maxCoeff(), 1e-9);
}

std::string messageOf(const TriMesh& mesh)
{
    try {
        buildMeshShape("thing", mesh);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::badInput);
        return error.what();
    }
    return "no error";
}

TEST(E10MassProperties, MeshesThatAreNoSolidAreRefusedWithThePlace)
{
    TriMesh open = makeBox(Vec3::Ones(), {1, 1, 1});
    open.triangles = open.triangles.leftCols(11).eval();
    EXPECT_NE(messageOf(open).find("'thing'"), std::string::npos);
    EXPECT_NE(messageOf(open).find("open edge at ("), std::string::npos);

    TriMesh twisted = makeBox(Vec3::Ones(), {1, 1, 1});
    std::swap(twisted.triangles(1, 0), twisted.triangles(2, 0));
    EXPECT_NE(messageOf(twisted).find("oriented against each other"), std::string::npos);

    TriMesh flat = makeBox(Vec3::Ones(), {1, 1, 1});
    flat.points.row(1).setZero();
    EXPECT_NE(messageOf(flat), "no error");

    TriMesh notANumber = makeBox(Vec3::Ones(), {1, 1, 1});
    notANumber.points(0, 0) = std::nan("");
    EXPECT_NE(messageOf(notANumber), "no error");
}

}  // namespace
}  // namespace scree
