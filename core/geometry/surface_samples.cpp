#include "core/geometry/surface_samples.h"

#include <algorithm>

#include "core/geometry/mesh_edges.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Below this angle between its faces an edge counts as lying inside a flat region [rad].
constexpr double kFlat = 1e-3;

/// Calls visit(side, angle) with one side of every edge and the angle between the normals of the
/// two triangles that it parts [rad].
template <class Visit>
void forAngles(const TriMesh& mesh, const Visit& visit)
{
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        if (sides.size() < 2) return;
        const Vec3 first = cornersOf(mesh, sides.front().triangle).areaVector();
        const Vec3 second = cornersOf(mesh, sides.back().triangle).areaVector();
        visit(sides.front(), angleBetween(first, second));
    });
}

}  // namespace

SurfaceSamples makeSurfaceSamples(const TriMesh& mesh, bool withEdges)
{
    SurfaceSamples samples;
    samples.vertices = mesh.points;

    std::vector<Ball> vertexSpheres(mesh.points.cols());
    for (std::size_t v = 0; v < vertexSpheres.size(); ++v) {
        vertexSpheres[v].centre = mesh.points.col(v);
    }
    samples.vertexTree = SphereTree(vertexSpheres);
    if (!withEdges) return samples;

    std::vector<Ball> edgeSpheres;
    forAngles(mesh, [&](const TriangleSide& side, double angle) {
        if (angle < kFlat) return;
        const Vec3 a = mesh.points.col(side.low), b = mesh.points.col(side.high);
        const double length = (b - a).norm();
        samples.edges.push_back({side.low, side.high});
        samples.edgeLengths.push_back(length);
        edgeSpheres.push_back({0.5 * (a + b), 0.5 * length});
    });
    samples.edgeTree = SphereTree(edgeSpheres);
    return samples;
}

double sharpestEdge(const TriMesh& mesh)
{
    double sharpest = 0.0;
    forAngles(mesh,
              [&](const TriangleSide&, double angle) { sharpest = std::max(sharpest, angle); });
    return sharpest;
}

int countSharperEdges(const TriMesh& mesh, double angle)
{
    int count = 0;
    forAngles(mesh, [&](const TriangleSide&, double between) { count += between > angle; });
    return count;
}

double longestEdge(const TriMesh& mesh)
{
    double longest = 0.0;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = mesh.points.col(mesh.triangles(k, f));
            const Vec3 b = mesh.points.col(mesh.triangles((k + 1) % 3, f));
            longest = std::max(longest, (b - a).norm());
        }
    }
    return longest;
}

}  // namespace scree
