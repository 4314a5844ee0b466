#include "core/geometry/level_set_build.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

constexpr float kBandVoxels = 3.0f;

openvdb::FloatGrid::Ptr narrowBand(const TriMesh& mesh, const GridNodes& nodes)
{
    openvdb::initialize();
    // Index space: one unit per node spacing, node (0, 0, 0) at the origin.
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.points.cols());
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const Vec3 p = (mesh.points.col(v) - nodes.origin) / nodes.spacing;
        points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
    }
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangles.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        triangles.emplace_back(mesh.triangles(0, f), mesh.triangles(1, f), mesh.triangles(2, f));
    }
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(
        points, triangles);
    const auto unitTransform = openvdb::math::Transform::createLinearTransform(1.0);
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *unitTransform, kBandVoxels,
                                                            std::numeric_limits<float>::max());
}

}  // namespace

void fillSignedDistance(const TriMesh& mesh, const SurfaceRays& rays, GridNodes& nodes)
{
    const openvdb::FloatGrid::Ptr band = narrowBand(mesh, nodes);
    const auto [nx, ny, nz] = nodes.count;
    nodes.values.resize(static_cast<std::size_t>(nx) * ny * nz);

    parallelFor(nz, 1, [&](std::size_t begin, std::size_t end) {
        auto accessor = band->getConstAccessor();
        for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k) {
            for (int j = 0; j < ny; ++j) {
                for (int i = 0; i < nx; ++i) {
                    const float voxels = accessor.getValue(openvdb::Coord(i, j, k));
                    double distance = nodes.spacing * voxels;
                    if (std::abs(voxels) >= kBandVoxels) {
                        const Vec3 p = nodes.origin + nodes.spacing * Vec3(i, j, k);
                        const int t = rays.closestTriangle(p);
                        const Vec3 closest =
                            closestOnTriangle(p, mesh.points.col(mesh.triangles(0, t)),
                                              mesh.points.col(mesh.triangles(1, t)),
                                              mesh.points.col(mesh.triangles(2, t)))
                                .point;
                        distance = std::copysign((p - closest).norm(), distance);
                    }
                    nodes.values[i + static_cast<std::size_t>(nx) *
                                         (j + static_cast<std::size_t>(ny) * k)] =
                        static_cast<float>(distance);
                }
            }
        }
    });
}

}  // namespace scree
