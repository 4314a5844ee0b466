// E21: the distance field against the mesh itself, cavities, walls too thin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/known_field.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/geometry/surface_normal.h"
#include "tests/support/draw.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Distance to all triangles one by one, signed by the solid angle they subtend.
double plainDistance(const TriMesh& mesh, const Vec3& p)
{
    double nearest = 1e300, angle = 0.0;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        nearest = std::min(nearest, (p - closestOnTriangle(p, corners).point).norm());
        const auto& [a, b, c] = corners;
        const Vec3 u = a - p, v = b - p, w = c - p;
        const double lu = u.norm(), lv = v.norm(), lw = w.norm();
        angle += 2.0 * std::atan2(u.dot(v.cross(w)),
                                  lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
    }
    return angle > 2.0 * std::numbers::pi ? -nearest : nearest;
}

// Of two equal corners the edge between them has no direction: the place was no number.
TEST(ClosestOnTriangle, WithoutAreaItIsOnAnEdgeOrACorner)
{
    for (std::uint64_t draw = 0; draw < 1000; ++draw) {
        const Vec3 p = signedUnits(draw, 0), q = signedUnits(draw, 3), r = signedUnits(draw, 6);
        const double t = std::clamp((p - q).dot(r - q) / (r - q).squaredNorm(), 0.0, 1.0);
        const double expected = (p - q - t * (r - q)).norm();
        for (const TriangleCorners& corners :
             {TriangleCorners{q, q, r}, TriangleCorners{q, r, r}, TriangleCorners{q, r, q}}) {
            EXPECT_NEAR((closestOnTriangle(p, corners).point - p).norm(), expected, 1e-12) << draw;
        }
        EXPECT_EQ(closestOnTriangle(p, {q, q, q}).point, q);
    }
}

TEST(E21SignedDistance, ACavityIsOutsideAndWhatLiesInItIsInside)  // [A4]
{
    // A ball of radius 1 with a cavity of 0.7, in which a ball of 0.3 lies.
    const TriMesh outer = makeSphere(1.0, 4), inner = makeSphere(0.3, 3);
    TriMesh hollow = makeSphere(0.7, 4);
    hollow.triangles.row(1).swap(hollow.triangles.row(2));
    TriMesh nested = outer;
    for (const TriMesh* part : std::initializer_list<const TriMesh*>{&hollow, &inner}) {
        const Eigen::Index points = nested.points.cols(), faces = nested.triangles.cols();
        nested.points.conservativeResize(3, points + part->points.cols());
        nested.points.rightCols(part->points.cols()) = part->points;
        nested.triangles.conservativeResize(3, faces + part->triangles.cols());
        nested.triangles.rightCols(part->triangles.cols()) =
            part->triangles.array() + static_cast<int>(points);
    }
    for (const FieldStorage storage : {FieldStorage::dense, FieldStorage::bricks}) {
        ShapeSettings settings;
        settings.storage = storage;
        settings.resolution = 64;
        const auto shape = buildMeshShape("nested", nested, settings);
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Vec3 p = randomPlace(21, i, shape->box);
            const double r = p.norm();
            const double exact = r < 0.5 ? r - 0.3 : r < 0.85 ? 0.7 - r : r - 1.0;
            // The spheres are polyhedra: 0.003 of a unit one lies inside; coarse blocks of bricks
            // interpolate over 8 voxels, but far from the surface.
            const double slack = storage == FieldStorage::dense ? 0.02 : 0.1;
            ASSERT_NEAR(shape->distance.value(p), exact, slack) << r;
            if (std::abs(exact) < 0.01) continue;
            ASSERT_EQ(shape->distance.value(p) < 0.0, exact < 0.0) << r;
        }
    }
}

/// OpenVDB keeps remnants of a band at the walls of a cavity, some voxels off: no distance can
/// change by more than the way between two nodes.
TEST(E21SignedDistance, DistancesAtTheWallsOfACavityChangeNoFasterThanTheWay)  // [A4]
{
    TriMesh bottle = makeCylinder(1.0, 2.0, 20, 6);
    TriMesh hollow = makeCylinder(0.8, 1.6, 20, 6);
    hollow.triangles.row(1).swap(hollow.triangles.row(2));
    const Eigen::Index points = bottle.points.cols(), faces = bottle.triangles.cols();
    bottle.points.conservativeResize(3, points + hollow.points.cols());
    bottle.points.rightCols(hollow.points.cols()) = hollow.points;
    bottle.triangles.conservativeResize(3, faces + hollow.triangles.cols());
    bottle.triangles.rightCols(hollow.triangles.cols()) =
        hollow.triangles.array() + static_cast<int>(points);
    ShapeSettings settings;
    settings.storage = FieldStorage::dense;
    settings.resolution = 72;
    const auto shape = buildMeshShape("bottle", bottle, settings);
    const NodeLayout& layout = shape->distance.field().nodes.layout;
    double worst = 0.0;
    for (int k = 1; k < layout.count[2]; ++k) {
        for (int j = 1; j < layout.count[1]; ++j) {
            for (int i = 1; i < layout.count[0]; ++i) {
                const double here = shape->distance.gridValue(layout.node(i, j, k));
                for (const auto& [di, dj, dk] : {std::array{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
                    const Vec3 before = layout.node(i - di, j - dj, k - dk);
                    worst = std::max(worst, std::abs(here - shape->distance.gridValue(before)));
                }
            }
        }
    }
    EXPECT_LE(worst, 1.001 * layout.spacing);
}

// Of the coarse field a cell lists up to dozens of triangles.
TEST(E21SignedDistance, ANonconvexMeshAgreesWithEveryTriangleAskedOneByOne)  // [A4]
{
    ShapeSettings coarse;
    coarse.resolution = 14;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    for (const auto& shape :
         {buildMeshShape("ring", ring), buildMeshShape("coarse", ring, coarse)}) {
        const SignedDistance& field = shape->distance;
        const double h = field.spacing();
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Vec3 p = randomPlace(21, i, shape->box.grown(3.0 * h));
            const double exact = plainDistance(shape->mesh, p), phi = field.value(p);
            const bool isNear = field.isRefined(field.gridValue(p));
            ASSERT_LE(std::abs(phi - exact), isNear ? 1e-12 : 0.88 * h) << p.transpose();
            ASSERT_EQ(phi < 0.0, exact < 0.0) << p.transpose();
            ASSERT_LE(field.lowerBound(p), exact + 1e-9) << p.transpose();
        }
    }
}

TEST(E21SignedDistance, WhatIsKnownOfFacesNearbyAnswersWithTheBitsOfTheField)  // [A4]
{
    const std::vector<std::shared_ptr<const Shape>> shapes = {
        buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10})),
        buildMeshShape("cube", makeBox(Vec3::Ones(), {1, 1, 1})),
        buildMeshShape("blade", makeBox({1.0, 0.04, 0.3}, {3, 1, 1})),
        buildMeshShape("ball", makeSphere(0.6, 3))};
    int held = 0, refined = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        const Shape& shape = *shapes[i % shapes.size()];
        const SignedDistance& field = shape.distance;
        KnownFaces known;
        const KnownField remembering(field, &known);
        Vec3 p = randomPlace(21, i, shape.box);
        for (int k = 0; k < 2; ++k) p -= field.sloped(p).value * field.sloped(p).gradient;
        // Steps from a thousandth of the spacing to half of it, each from where the last one led.
        for (std::uint64_t step = 0; step < 60; ++step) {
            const double size = field.spacing() * std::pow(500.0, -randomUnit(22, i, step));
            for (int k = 0; k < 3; ++k) p[k] += size * (randomUnit(23 + k, i, step) - 0.5);
            refined += field.isRefined(field.gridValue(p));
            held += known.holding(p) != nullptr;
            if (step % 2 == 0) {
                ASSERT_EQ(remembering.value(p), field.value(p)) << shape.name;
                continue;
            }
            const SignedDistance::Sloped told = remembering.sloped(p), plain = field.sloped(p);
            ASSERT_EQ(told.value, plain.value) << shape.name;
            ASSERT_EQ(told.gradient, plain.gradient) << shape.name;
        }
    }
    EXPECT_GT(held, 0.5 * refined);
}

TEST(E21SignedDistance, APointThatCrossesAFaceGetsThatFaceHoweverNearTheEdge)  // [A6]
{
    const auto shape = buildMeshShape("cube", makeBox(Vec3::Ones(), {2, 2, 2}));
    for (double fromEdge : {5e-4, 1e-4, 1e-5}) {
        const Vec3 above(0.5 - fromEdge, 0.5 + 1e-4, 0.1), below(0.5 - fromEdge, 0.5 - 1e-3, 0.1);
        // Where it is predicted to be, the side is nearer than the top it came through.
        const Approach falling{below, {0.0, -1.0, 0.0}, above, below};
        EXPECT_LE((surfaceNormal(*shape, falling) - Vec3::UnitY()).norm(), 1e-12) << fromEdge;
    }
}

TEST(E21SignedDistance, AWallTooThinForTheLargestFieldIsRefusedWithWhatItNeeds)  // [A4]
{
    const Refusal refusal = refusalBy([&] {
        buildMeshShape("sheet", makeBox({1.0, 0.001, 1.0}, {1, 1, 1}));
    });
    EXPECT_TRUE(refusal.mentions("'sheet'"));
    EXPECT_TRUE(refusal.mentions("12000 voxels")) << refusal.message;
}

}  // namespace
}  // namespace scree::test
