// Groups the faces around every point by the creases between them, then sums normals by group.
// Corner c of triangle f has the index 3 f + c; its edge runs to the next corner of f.
#include "core/picture/shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "core/base/disjoint_sets.h"
#include "core/geometry/tri_mesh.h"

namespace scree {
namespace {

int nextCorner(int corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

int pointAt(const Triangles& triangles, int corner)
{
    return triangles(corner % 3, corner / 3);
}

/// Unit normals as columns, zero for a triangle without area.
Points faceNormals(const TriMesh& mesh)
{
    Points normals(3, mesh.triangles.cols());
    for (Eigen::Index f = 0; f < normals.cols(); ++f) {
        normals.col(f) = cornersOf(mesh, f).normal();
    }
    return normals;
}

/// Angle of the triangle at a corner [rad].
double cornerAngle(const TriMesh& mesh, int corner)
{
    const int b = nextCorner(corner), c = nextCorner(b);
    const Vec3 apex = mesh.points.col(pointAt(mesh.triangles, corner));
    const Vec3 toB = mesh.points.col(pointAt(mesh.triangles, b)) - apex;
    const Vec3 toC = mesh.points.col(pointAt(mesh.triangles, c)) - apex;
    return std::atan2(toB.cross(toC).norm(), toB.dot(toC));
}

/// An edge of a triangle: the pair of its points, and the corner where it starts.
struct HalfEdge {
    int from, to;
    int corner;

    std::pair<int, int> undirected() const { return {std::min(from, to), std::max(from, to)}; }
};

/// Sorted so that the half edges of one edge are neighbours, in the order of their corners.
std::vector<HalfEdge> sortedHalfEdges(const Triangles& triangles)
{
    std::vector<HalfEdge> edges(3 * triangles.cols());
    for (int corner = 0; corner < static_cast<int>(edges.size()); ++corner)
        edges[corner] = {pointAt(triangles, corner), pointAt(triangles, nextCorner(corner)),
                         corner};
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::make_pair(a.undirected(), a.corner) < std::make_pair(b.undirected(), b.corner);
    });
    return edges;
}

/// Joins corners across every smooth edge, at both of its ends. True when all edges are shared by
/// two triangles of opposite sense, which makes the surface closed.
bool joinAcrossSmoothEdges(const TriMesh& mesh, const Points& normals, double creaseDegrees,
                           DisjointSets& groups)
{
    const double smoothest = std::cos(creaseDegrees * std::numbers::pi / 180.0);
    const std::vector<HalfEdge> edges = sortedHalfEdges(mesh.triangles);
    bool isClosed = true;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].undirected() == edges[begin].undirected()) ++end;
        const bool isShared = end - begin == 2 && edges[begin].from == edges[begin + 1].to;
        isClosed = isClosed && isShared;
        if (!isShared) continue;
        const int cornerA = edges[begin].corner, cornerB = edges[begin + 1].corner;
        if (normals.col(cornerA / 3).dot(normals.col(cornerB / 3)) < smoothest) continue;
        groups.join(cornerA, nextCorner(cornerB));
        groups.join(nextCorner(cornerA), cornerB);
    }
    return isClosed;
}

/// For every corner the first one of its group that is seen at the same place of the texture.
std::vector<int> drawnCorners(DisjointSets& groups, const TriMesh& mesh)
{
    std::vector<int> drawnAs(static_cast<std::size_t>(mesh.triangles.size()));
    std::map<std::tuple<int, float, float>, int> firstAt;
    for (int corner = 0; corner < static_cast<int>(drawnAs.size()); ++corner) {
        drawnAs[corner] = static_cast<int>(groups.find(corner));
        if (mesh.cornerUvs.cols() == 0) continue;
        const Eigen::Vector2f uv = mesh.cornerUvs.col(corner);
        const auto entry = firstAt.try_emplace({drawnAs[corner], uv.x(), uv.y()}, corner).first;
        drawnAs[corner] = entry->second;
    }
    return drawnAs;
}

/// Half the diagonal of the bounding box around its centre: at most √3 times the smallest ball.
void setBall(ShadedMesh& mesh, const Points& points)
{
    if (points.cols() == 0) return;
    mesh.centre = 0.5 * (points.rowwise().minCoeff() + points.rowwise().maxCoeff());
    mesh.radius = std::sqrt((points.colwise() - mesh.centre).colwise().squaredNorm().maxCoeff());
}

}  // namespace

ShadedMesh shadeMesh(const SceneMesh& sceneMesh, double creaseDegrees)
{
    const TriMesh mesh =
        mergeEqualPoints({sceneMesh.points, sceneMesh.triangles, sceneMesh.cornerUvs});
    const Points normals = faceNormals(mesh);
    const int cornerCount = static_cast<int>(3 * mesh.triangles.cols());

    // Find which corners look like one smooth piece of surface.
    ShadedMesh result;
    DisjointSets groups(cornerCount);
    result.isClosed = joinAcrossSmoothEdges(mesh, normals, creaseDegrees, groups);

    // Sum the normals of each group.
    Points groupNormals = Points::Zero(3, cornerCount);
    for (int corner = 0; corner < cornerCount; ++corner)
        groupNormals.col(groups.find(corner)) +=
            cornerAngle(mesh, corner) * normals.col(corner / 3);

    // Give each group one point, or one for each place of the texture it is seen at.
    const std::vector<int> drawnAs = drawnCorners(groups, mesh);
    result.indices.resize(cornerCount);
    for (int corner = 0; corner < cornerCount; ++corner) {
        if (drawnAs[corner] == corner) {
            const int group = groups.find(corner);
            result.indices[corner] = static_cast<std::uint32_t>(result.points.size());
            result.points.push_back(mesh.points.col(pointAt(mesh.triangles, corner)).cast<float>());
            result.normals.push_back(groupNormals.col(group).normalized().cast<float>());
            if (mesh.cornerUvs.cols() > 0) result.uvs.push_back(mesh.cornerUvs.col(corner));
        }
        result.indices[corner] = result.indices[drawnAs[corner]];
    }
    setBall(result, mesh.points);
    return result;
}

Eigen::Matrix3Xf cornerNormals(const SceneMesh& mesh)
{
    const ShadedMesh shaded = shadeMesh(mesh);
    Eigen::Matrix3Xf normals(3, mesh.triangles.size());
    std::size_t next = 0;  // corner in `shaded`, which leaves out triangles with two equal corners
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const Vec3 a = mesh.points.col(mesh.triangles(0, f));
        const Vec3 b = mesh.points.col(mesh.triangles(1, f));
        const Vec3 c = mesh.points.col(mesh.triangles(2, f));
        const bool hasNormals = a != b && b != c && c != a;
        for (int corner = 0; corner < 3; ++corner) {
            normals.col(3 * f + corner) = hasNormals ? shaded.normals[shaded.indices[next++]]
                                                     : Eigen::Vector3f(Eigen::Vector3f::UnitY());
        }
    }
    return normals;
}

}  // namespace scree
