#include "core/geometry/level_set_surface.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <vector>

namespace scree {
namespace {

constexpr float kBandVoxels = 3.0f;

/// Where the lattice begins, in spacings before the low corner of the box. Odd fractions, because a
/// node that lies exactly on the surface makes triangles without area, and round lengths are
/// common.
const Vec3 kHeadStart(0.37, 0.29, 0.43);

/// One unit of index space per spacing, node (0, 0, 0) at `origin`.
openvdb::FloatGrid::Ptr sampleBand(const std::function<double(const Vec3&)>& phi,
                                   const Vec3& origin, const Vec3& last, double spacing)
{
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(kBandVoxels);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    auto accessor = grid->getAccessor();
    const Vec3 cells = ((last - origin) / spacing).array().ceil();
    for (int k = 0; k <= static_cast<int>(cells.z()); ++k) {
        for (int j = 0; j <= static_cast<int>(cells.y()); ++j) {
            for (int i = 0; i <= static_cast<int>(cells.x()); ++i) {
                const double value = phi(origin + spacing * Vec3(i, j, k)) / spacing;
                const auto voxels = static_cast<float>(
                    std::clamp(value, -double{kBandVoxels}, double{kBandVoxels}));
                // Outside, the background says the same.
                if (voxels < kBandVoxels) accessor.setValue(openvdb::Coord(i, j, k), voxels);
            }
        }
    }
    return grid;
}

}  // namespace

TriMesh surfaceOf(const std::function<double(const Vec3&)>& phi, const Aabb& box, double spacing)
{
    const Vec3 origin = box.min - spacing * kHeadStart;
    const openvdb::FloatGrid::Ptr grid = sampleBand(phi, origin, box.max, spacing);
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0);

    TriMesh mesh;
    mesh.points.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t v = 0; v < points.size(); ++v) {
        const Vec3 p(points[v].x(), points[v].y(), points[v].z());
        mesh.points.col(static_cast<Eigen::Index>(v)) = origin + spacing * p;
    }
    // OpenVDB's polygons are clockwise seen from outside.
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size() + 2 * quads.size()));
    Eigen::Index f = 0;
    for (const openvdb::Vec3I& t : triangles) mesh.triangles.col(f++) << t[2], t[1], t[0];
    for (const openvdb::Vec4I& q : quads) {
        mesh.triangles.col(f++) << q[2], q[1], q[0];
        mesh.triangles.col(f++) << q[0], q[3], q[2];
    }
    return mesh;
}

}  // namespace scree
