#include "core/geometry/surface_samples.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/math/rotation.h"

namespace scree {
namespace {

/// Below this angle between its faces an edge counts as lying inside a flat region [rad].
constexpr double kFlat = 1e-3;

/// Angle between the normals of the two triangles at every undirected edge [rad].
std::map<std::pair<int, int>, double> dihedralAngles(const TriMesh& mesh)
{
    std::map<std::pair<int, int>, Vec3> firstNormal;
    std::map<std::pair<int, int>, double> angles;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const Vec3 normal = cornersOf(mesh, f).areaVector();
        for (int k = 0; k < 3; ++k) {
            const auto ends = std::minmax(mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f));
            const auto [entry, isNew] = firstNormal.try_emplace(ends, normal);
            if (!isNew) angles[ends] = angleBetween(entry->second, normal);
        }
    }
    return angles;
}

}  // namespace

SurfaceSamples makeSurfaceSamples(const TriMesh& mesh, bool withEdges)
{
    SurfaceSamples samples;
    samples.vertices = mesh.points;

    std::vector<Sphere> vertexSpheres(mesh.points.cols());
    for (std::size_t v = 0; v < vertexSpheres.size(); ++v) {
        vertexSpheres[v].centre = mesh.points.col(v);
    }
    samples.vertexTree = SphereTree(vertexSpheres);
    if (!withEdges) return samples;

    std::vector<Sphere> edgeSpheres;
    for (const auto& [ends, angle] : dihedralAngles(mesh)) {
        if (angle < kFlat) continue;
        const Vec3 a = mesh.points.col(ends.first), b = mesh.points.col(ends.second);
        const double length = (b - a).norm();
        samples.edges.push_back({ends.first, ends.second});
        samples.edgeLengths.push_back(length);
        edgeSpheres.push_back({0.5 * (a + b), 0.5 * length});
    }
    samples.edgeTree = SphereTree(edgeSpheres);
    return samples;
}

double sharpestEdge(const TriMesh& mesh)
{
    double sharpest = 0.0;
    for (const auto& [ends, angle] : dihedralAngles(mesh)) sharpest = std::max(sharpest, angle);
    return sharpest;
}

int countSharperEdges(const TriMesh& mesh, double angle)
{
    int count = 0;
    for (const auto& [ends, between] : dihedralAngles(mesh)) count += between > angle;
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
