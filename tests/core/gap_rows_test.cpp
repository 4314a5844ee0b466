// Which row begins with which impulse of the step before.
#include "core/dynamics/gaps/gap_rows.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/dynamics/gaps/gap_kept.h"
#include "core/dynamics/gaps/gap_layout.h"
#include "core/dynamics/gaps/gap_scratch.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kStep = 1.0 / 96.0;

/// A bent rod on its two round ends.
World bridge()
{
    TriMesh mesh = makeCapsule(0.1, 1.0, 32, 8);
    for (int i = 0; i < mesh.points.cols(); ++i)
        mesh.points(0, i) += 0.5 * mesh.points(1, i) * mesh.points(1, i);
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId body = addBody(world, buildMeshShape("bridge", mesh), material,
                                {Vec3::Zero(), exponentialMap(Vec3(0.0, 0.0, -0.5 * kPi))});
    const Shape& shape = world.shapeOf(body);
    const Mat3 turn = world.motion[body].orientation.toRotationMatrix();
    world.motion[body].position.y() = -(turn * shape.mesh.points).row(1).minCoeff();
    return world;
}

void layRows(World& world, GapScratch& scratch)
{
    const StepSettings settings = screeSettings();
    layOutGaps(world, settings, kStep, SolvedIslands(), scratch);
    for (const GapBlock& block : scratch.blocks) buildRows(world, settings, kStep, block, scratch);
}

// The first place of the name took what another had borne: bananas in a crate began every step
// with the weight of a few at the wrong end, and none fell asleep.
TEST(GapRows, WhatOnePlaceBoreIsNotGivenToAnotherOfItsName)
{
    World world = bridge();
    GapScratch scratch;
    layRows(world, scratch);
    ASSERT_EQ(scratch.pairs.size(), 1);
    const std::vector<GapRow> rows = scratch.rows;
    const std::vector<GapContact> contacts = scratch.contactsOf(scratch.pairs[0]);
    ASSERT_GE(rows.size(), 2);
    const Quat aFromWorld = world.motion[rows[0].a].orientation.conjugate();
    for (std::size_t bears = 0; bears < rows.size(); ++bears) {
        ASSERT_EQ(contacts[bears].feature, contacts[0].feature);
        const Vec3 force = 3.0 * rows[bears].normal;
        world.contactMemory.contacts = {{rows[bears].a, rows[bears].b, contacts[bears].feature,
                                         aFromWorld * rows[bears].rA, force}};
        layRows(world, scratch);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            EXPECT_NEAR(scratch.rows[r].impulse.x(), r == bears ? 3.0 * kStep : 0.0, 1e-12)
                << r << " of " << rows.size() << " where " << bears << " bears";
        }
    }
}

}  // namespace
}  // namespace scree::test
