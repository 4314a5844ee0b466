// Bones in a funnel: what a pair of them remembers changes no contact. Here because their meshes
// have to be read.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/collision/near_features.h"
#include "core/math/rotation.h"
#include "io/mesh_import.h"
#include "tests/support/draw.h"
#include "tests/support/import_mesh.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

std::shared_ptr<const Shape> boneShape(const std::string& name)
{
    TriMesh mesh = importMesh(sourceFile("shots/meshes/" + name + ".ply").string());
    mesh.points *= 0.8;
    ShapeSettings settings;
    settings.resolution = 96;
    return buildMeshShape(name, mesh, settings);
}

/// The planes beside a small crease may be nearer to a corner than anything of the surface. They
/// were told of as long as nobody knew that the corner was far, which a pair that is seen for the
/// first time may know at once.
TEST(NearBones, WhatAPairRemembersChangesNoContactInItsCreases)
{
    const auto skull = boneShape("skull"), femur = boneShape("femur");
    std::size_t contacts = 0;
    for (std::uint64_t run = 0; run < 120; ++run) {
        const Shape& other = run % 2 == 0 ? *skull : *femur;
        PlacedPair pair{
            skull.get(),
            &other,
            {0.4 * signedUnits(run, 0).normalized(), exponentialMap(3.0 * signedUnits(run, 3))},
            Pose{}};
        const Vec3 step = 0.005 * signedUnits(run, 9), turn = 0.01 * signedUnits(run, 12);
        const double reach = 0.006 + 0.014 * randomUnit(7, run, 15);
        NearFeatures remembering;
        for (int i = 0; i < 40; ++i) {
            pair.worldFromA.position += step;
            pair.worldFromA.orientation = rotated(pair.worldFromA.orientation, turn);
            std::vector<GapContact> remembered, fresh;
            remembering.findContacts(pair, reach, remembered);
            NearFeatures().findContacts(pair, reach, fresh);
            ASSERT_TRUE(std::ranges::equal(remembered, fresh,
                                           [](const auto& p, const auto& q) {
                                               return p.feature == q.feature && p.gap == q.gap;
                                           }))
                << run << ' ' << i;
            contacts += fresh.size();
        }
    }
    EXPECT_GT(contacts, 5000u);
}

}  // namespace
}  // namespace scree::test
