// E21: the two storages of a distance field, and what blocks know without being sampled.
// [A10, A11]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/level_set_build.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/geometry/shape_store.h"
#include "tests/support/draw.h"

namespace scree::test {
namespace {

std::shared_ptr<const Shape> stored(const TriMesh& mesh, FieldStorage storage, int resolution = 96)
{
    ShapeSettings settings;
    settings.resolution = resolution;
    settings.storage = storage;
    return buildMeshShape("shape", mesh, settings);
}

int coarseBlocks(const Shape& shape)
{
    const auto& blocks = shape.distance.field().nodes.blocks;
    return static_cast<int>(
        std::count_if(blocks.begin(), blocks.end(), [](const auto& b) { return b.isCoarse; }));
}

/// A ring with much empty space, and a block with much of it inside.
std::vector<TriMesh> someMeshes()
{
    return {makeTorus(1.0, 0.25, {24, 16}), makeBox({1.0, 0.9, 1.1}, {2, 2, 2})};
}

TEST(E21FieldStorage, BricksPromiseNoMoreDistanceThanThereIs)
{
    // A sphere's own formula is the judge; its mesh lies at most this much inside.
    const double radius = 0.5, sag = 0.002;
    const auto bricks = stored(makeSphere(radius, 4), FieldStorage::bricks);
    ASSERT_GT(coarseBlocks(*bricks), 10);
    for (std::uint64_t i = 0; i < 100000; ++i) {
        const Vec3 p = randomPlace(32, i, bricks->box.grown(0.05));
        const double exact = p.norm() - radius;
        ASSERT_LE(bricks->distance.lowerBound(p), exact + sag) << p.transpose();
        // What a block says unasked holds as well.
        const double reach = 0.1 * randomUnit(33, i);
        if (bricks->distance.isClearOf(p, reach)) {
            ASSERT_GT(exact + sag, reach) << p.transpose();
        }
    }
}

TEST(E21FieldStorage, BricksHaveNoCracksBetweenFineAndCoarse)
{
    for (const TriMesh& mesh : someMeshes()) {
        const auto bricks = stored(mesh, FieldStorage::bricks);
        const DistanceNodes& nodes = bricks->distance.field().nodes;
        const double h = nodes.layout.spacing;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            // Two points astride a plane between blocks, a millionth of a cell apart.
            Vec3 low = randomPlace(34, i, bricks->box);
            const int axis = static_cast<int>(i % 3);
            const double block = std::round((low[axis] - nodes.layout.origin[axis]) / (8.0 * h));
            low[axis] = nodes.layout.origin[axis] + 8.0 * h * block - 5e-7 * h;
            Vec3 high = low;
            high[axis] += 1e-6 * h;
            // Single precision of the values; a crack would be a good part of a cell.
            ASSERT_NEAR(bricks->distance.gridValue(low), bricks->distance.gridValue(high),
                        1e-4 * h);
        }
    }
}

TEST(E21FieldStorage, AutomaticTakesBricksWhereTheySaveMuchOfALargeField)
{
    const auto storageOf = [](const TriMesh& mesh, int resolution) {
        ShapeSettings settings;
        settings.resolution = resolution;
        return buildMeshShape("shape", mesh, settings)->distance.field().nodes.storage;
    };
    EXPECT_EQ(storageOf(makeTorus(1.0, 0.25, {16, 10}), 48), FieldStorage::dense);
    EXPECT_EQ(storageOf(makeSphere(1.0, 2), 120), FieldStorage::bricks);
}

/// Keeps one field in memory, and can spoil it.
class OneField : public ShapeStore {
public:
    std::optional<DistanceField> findField(std::uint64_t) override { return field; }
    void keepField(std::uint64_t, const DistanceField& built) override
    {
        field = built;
        ++timesKept;
    }
    std::optional<TriMesh> findSolid(std::uint64_t) override { return {}; }
    void keepSolid(std::uint64_t, const TriMesh&) override {}
    std::optional<DistanceField> field;
    int timesKept = 0;
};

TEST(E21FieldStorage, AKeptFieldOfOtherFacesOrAnotherLatticeIsBuiltAnew)
{
    OneField store;
    const TriMesh cube = makeBox(Vec3::Ones(), {2, 2, 2});
    const auto build = [&] { return buildMeshShape("cube", cube, {}, &store); };
    build();
    build();
    ASSERT_EQ(store.timesKept, 1);
    store.field->nearest.faces.back().face = static_cast<std::uint32_t>(cube.triangles.cols());
    const auto shape = build();
    EXPECT_EQ(store.timesKept, 2);
    EXPECT_NEAR(shape->distance.value({0.5 + 1e-3, 0.1, 0.1}), 1e-3, 1e-12);
    store.field->nodes.layout.origin.x() += 1.0;
    build();
    EXPECT_EQ(store.timesKept, 3);
}

TEST(E21FieldStorage, TheFieldHasTheSameBitsForAnyThreadCount)
{
    const TriMesh mesh = makeTorus(1.0, 0.25, {32, 20});
    for (const FieldStorage storage : {FieldStorage::dense, FieldStorage::bricks}) {
        std::vector<DistanceField> fields;
        for (const int threads : {1, 2, 4}) {
            setThreadCount(threads);
            const SurfaceRays rays(mesh);
            DistanceField field;
            field.nodes =
                buildDistanceNodes(mesh, rays, {{-1.5, -0.5, -1.5}, 0.05, {61, 21, 61}}, storage);
            field.nearest = findNearestFaces(mesh, field.nodes);
            fields.push_back(field);
        }
        setThreadCount(1);
        for (const int other : {1, 2}) {
            EXPECT_EQ(fields[0].nodes.values, fields[other].nodes.values);
            EXPECT_EQ(fields[0].nearest.start, fields[other].nearest.start);
            EXPECT_EQ(fields[0].nearest.faces, fields[other].nearest.faces);
        }
    }
}

/// A bottle with walls of 0.02 m and a bore of radius `bore` in its lid, 0.2 m wide and high [m].
TriMesh bottle(double bore)
{
    constexpr int kSectors = 32;
    const std::vector<std::pair<double, double>> profile = {
        {0.1, 0.0}, {0.1, 0.2}, {bore, 0.2}, {bore, 0.18}, {0.08, 0.18}, {0.08, 0.02}};
    const int rows = static_cast<int>(profile.size()), bottom = rows * kSectors, floor = bottom + 1;
    TriMesh mesh{Points(3, floor + 1), Triangles(3, 2 * kSectors * rows)};
    mesh.points.col(bottom).setZero();
    mesh.points.col(floor) << 0.0, 0.02, 0.0;
    Eigen::Index f = 0;
    for (int k = 0; k < kSectors; ++k) {
        const double angle = 2.0 * kPi * k / kSectors;
        const int next = (k + 1) % kSectors;
        for (int row = 0; row < rows; ++row) {
            const auto [r, y] = profile[static_cast<std::size_t>(row)];
            mesh.points.col(row * kSectors + k) << r * std::cos(angle), y, r * std::sin(angle);
            if (row == 0) continue;
            const int a = (row - 1) * kSectors + k, b = (row - 1) * kSectors + next;
            mesh.triangles.col(f++) << a, a + kSectors, b;
            mesh.triangles.col(f++) << b, a + kSectors, b + kSectors;
        }
        mesh.triangles.col(f++) << bottom, k, next;
        const int last = (rows - 1) * kSectors;
        mesh.triangles.col(f++) << floor, last + next, last + k;
    }
    return mesh;
}

// OpenVDB's flood does not pass a hole of less than two voxels: all of the bottle was solid.
TEST(E21FieldStorage, ACavityIsOutsideHoweverNarrowTheWayIntoIt)
{
    for (const double bore : {0.0005, 0.012}) {
        const TriMesh mesh = bottle(bore);
        ASSERT_GT(signedVolume(mesh), 0.0);
        for (const FieldStorage storage : {FieldStorage::dense, FieldStorage::bricks}) {
            const auto shape = stored(mesh, storage, 40);
            const Vec3 middle = shape->bodyFromAsset * Vec3(0.0, 0.1, 0.0);
            EXPECT_GT(shape->distance.value(middle), 0.05) << bore;
            for (std::uint64_t i = 0; i < 2000; ++i) {
                const Vec3 p = 0.07 * signedUnits(41, 3 * i);
                if (std::hypot(p.x(), p.z()) > 0.075) continue;
                ASSERT_GT(shape->distance.value(middle + shape->bodyFromAsset.orientation * p), 0.0)
                    << bore << ": " << p.transpose();
            }
        }
    }
}

}  // namespace
}  // namespace scree::test
