// What of a mesh is told to others, where it was once told wrongly: cavities, surfaces cut finely,
// what is thin, edges in many pieces.
#include "core/geometry/contact_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/both_meshes.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Of `a` as it was modelled, moved to `place`, and `b` as it was.
std::vector<GapContact> contactsOf(const Shape& a, const Vec3& place, const Shape& b, double reach)
{
    std::vector<GapContact> contacts;
    const Pose worldFromAsset{place, Quat::Identity()};
    NearFeatures().findContacts(
        {&a, &b, worldFromAsset * inverse(a.bodyFromAsset), inverse(b.bodyFromAsset)}, reach,
        contacts);
    return contacts;
}

std::shared_ptr<const Shape> coarselySampled(const TriMesh& mesh, MeshRepair repair)
{
    ShapeSettings settings;
    settings.resolution = 40;
    settings.repair = repair;
    return buildMeshShape("shape", mesh, settings);
}

/// A box with a cavity that leaves walls of a tenth of its edge.
std::shared_ptr<const Shape> hollowBox()
{
    TriMesh cavity = makeBox(Vec3::Constant(0.8), {1, 1, 1});
    turnInsideOut(cavity);
    return coarselySampled(both(makeBox(Vec3::Ones(), {1, 1, 1}), cavity), MeshRepair::none);
}

// All corners of a cavity lie behind all faces outside: it passed for convex, and what was pressed
// against its floor was told the way out below.
TEST(ContactFeatures, WhatLiesInACavityLeavesIntoIt)
{
    const auto hollow = hollowBox(), cube = boxShape(Vec3::Constant(0.2), 1);
    EXPECT_FALSE(hollow->features.isConvex());
    TriMesh fromInside = makeBox(Vec3::Ones(), {1, 1, 1});
    turnInsideOut(fromInside);
    EXPECT_FALSE(coarselySampled(fromInside, MeshRepair::room)->features.isConvex());
    for (const double depth : {0.0005, 0.002, 0.01}) {
        const auto contacts = contactsOf(*cube, {0.0, -0.3 - depth, 0.0}, *hollow, 0.001);
        ASSERT_EQ(contacts.size(), 4u) << depth;
        for (const GapContact& contact : contacts) {
            EXPECT_NEAR(contact.normal.y(), 1.0, 1e-6) << depth;
            EXPECT_NEAR(contact.gap, -depth, 1e-6) << depth;
        }
    }
}

/// Flat above, below a part of a sphere: `rings` of `sectors` quads up to `half` from its axis.
TriMesh lens(double half, double radius, int rings, int sectors)
{
    const auto height = [&](double r) { return radius - std::sqrt(radius * radius - r * r); };
    TriMesh mesh{Points(3, 2 + rings * sectors), Triangles(3, 2 * rings * sectors)};
    const int top = rings * sectors + 1;
    mesh.points.col(0).setZero();
    mesh.points.col(top) << 0.0, height(half) + 0.1 * half, 0.0;
    const auto at = [&](int ring, int k) {
        return ring < 0 ? 0 : ring == rings ? top : 1 + ring * sectors + k % sectors;
    };
    Eigen::Index f = 0;
    const auto add = [&](int a, int b, int c) { mesh.triangles.col(f++) << a, b, c; };
    for (int ring = 0; ring < rings; ++ring) {
        for (int k = 0; k < sectors; ++k) {
            const double r = half * (ring + 1) / rings, angle = 2.0 * kPi * k / sectors;
            mesh.points.col(at(ring, k)) << r * std::cos(angle), height(r), r * std::sin(angle);
            add(at(ring - 1, k), at(ring, k), at(ring, k + 1));
            if (ring > 0) add(at(ring - 1, k), at(ring, k + 1), at(ring - 1, k + 1));
        }
    }
    for (int k = 0; k < sectors; ++k) add(at(rings - 1, k), top, at(rings - 1, k + 1));
    return mesh;
}

// No edge of its dome bends by as much as counts. It sank by 0.3 mm, all that the dome stands out.
TEST(ContactFeatures, AGentleDomeStandsOnItself)
{
    const TriMesh mesh = lens(0.025, 1.0, 60, 120);
    ASSERT_GT(signedVolume(mesh), 0.0);
    const auto shape = coarselySampled(mesh, MeshRepair::none);
    const auto plane = buildPlaneShape("plane");
    const auto contacts = contactsOf(*shape, Vec3::Zero(), *plane, 1e-4);
    ASSERT_FALSE(contacts.empty());
    double least = 1.0;
    for (const GapContact& contact : contacts) least = std::min(least, contact.gap);
    EXPECT_NEAR(least, 0.0, 1e-6);
}

// The two lower corners at an end of a rod were one place, on one of its sides: it rocked about
// that for ever.
TEST(ContactFeatures, AThinRodLiesOnBothItsSides)
{
    const auto plane = buildPlaneShape("plane");
    for (const double thick : {0.002, 0.004, 0.02}) {
        const auto rod = exactBox({1.0, thick, thick}, 1);
        EXPECT_EQ(contactsOf(*rod, {0.0, 0.5 * thick, 0.0}, *plane, 1e-4).size(), 4u) << thick;
    }
}

// Two cubes of 64 segments took 9 ms to be told the way out of each other, of one 7 µs.
TEST(ContactFeatures, StraightEdgesAreAskedOnceHoweverManyPiecesTheyHave)
{
    for (const int segments : {1, 2, 16}) {
        const auto cube = boxShape(Vec3::Ones(), segments);
        EXPECT_EQ(cube->features.hullEdges().size(), 12u) << segments;
    }
    EXPECT_EQ(prismShape()->features.hullEdges().size(), 9u);
}

}  // namespace
}  // namespace scree::test
