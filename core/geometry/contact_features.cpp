#include "core/geometry/contact_features.h"

#include <algorithm>

#include "core/geometry/mesh_edges.h"

namespace scree {
namespace {

/// Sine of the bend below which an edge lies inside a flat region.
constexpr double kFlat = 1e-3;

/// Cosine of the bend up to which an edge is one of a fine surface, and sine of that inward which
/// makes a notch.
constexpr double kFine = 0.7, kNotch = 0.05;

/// What is convex may bulge by this share of its size, as faces of more than three corners do; and
/// has at most so many corners, since all are asked about.
constexpr double kBulges = 1e-4;
constexpr std::size_t kFewCorners = 64;

void addDirection(std::vector<Vec3>& directions, const Vec3& direction)
{
    for (const Vec3& known : directions) {
        if ((known - direction).squaredNorm() < kFlat * kFlat) return;
    }
    directions.push_back(direction);
}

/// The corner of its face that is not on the side.
Vec3 oppositeCorner(const TriMesh& mesh, const TriangleSide& side)
{
    return mesh.points.col(mesh.triangles((side.corner + 2) % 3, side.triangle));
}

EdgeLine lineOf(const ConvexEdge& edge)
{
    Eigen::Matrix<double, 16, 1> numbers;
    const double length = touchesBetweenEndsAlone(edge) ? -edge.length : edge.length;
    numbers << edge.start, length, edge.direction, edge.outward, edge.intoFace[0], edge.intoFace[1];
    EdgeLine line;
    Eigen::Map<Eigen::Matrix<float, 16, 1>>(line.numbers.data()) = numbers.cast<float>();
    return line;
}

}  // namespace

ContactFeatures::ContactFeatures(const TriMesh& mesh) : points_(mesh.points)
{
    std::vector<std::vector<Vec3>> around(points_.cols()), normals(points_.cols());
    std::vector<char> isFine(points_.cols(), 1);
    std::vector<Ball> edgeSpheres, creaseSpheres;
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        const std::array<int, 2> ends = {sides[0].low, sides[0].high};
        const Vec3 start = points_.col(ends[0]), end = points_.col(ends[1]);
        const double length = (end - start).norm();
        const Vec3 direction = (end - start) / length;
        around[ends[0]].push_back(direction);
        around[ends[1]].push_back(-direction);

        ConvexEdge edge{ends, start, direction, length, {}, {}, {}, {}, {}};
        for (int side = 0; side < 2; ++side) {
            edge.faceNormal[side] = cornersOf(mesh, sides[side].triangle).normal();
            const Vec3 across = oppositeCorner(mesh, sides[side]) - start;
            edge.intoFace[side] = (across - across.dot(direction) * direction).normalized();
            for (const int point : ends) addDirection(normals[point], edge.faceNormal[side]);
        }
        // Convex: each face falls away behind the plane of the other.
        const double rises = edge.intoFace[1].dot(edge.faceNormal[0]);
        if (rises > kFlat && edge.faceNormal[0].dot(edge.faceNormal[1]) < kCrease) {
            creases_.push_back({start, direction, length, edge.faceNormal, edge.intoFace});
            creaseSpheres.push_back({0.5 * (start + end), 0.5 * length});
        }
        if (rises > kNotch || edge.faceNormal[0].dot(edge.faceNormal[1]) < kFine)
            for (const int point : ends) isFine[point] = 0;
        if (rises > -kFlat) return;
        edge.outward = (edge.faceNormal[0] + edge.faceNormal[1]).normalized();
        hasBlades_ = hasBlades_ || edge.faceNormal[0].dot(edge.faceNormal[1]) < kBlade;
        edges_.push_back(edge);
        edgeSpheres.push_back({0.5 * (start + end), 0.5 * length});
    });

    neighbourStart_.assign(points_.cols() + 1, 0);
    for (std::size_t v = 0; v < around.size(); ++v) {
        neighbours_.insert(neighbours_.end(), around[v].begin(), around[v].end());
        neighbourStart_[v + 1] = static_cast<std::uint32_t>(neighbours_.size());
    }
    // A point with faces in one or two directions lies inside a flat region or a straight edge:
    // edges go on there, and whatever touches it also touches the region's true corners or edges.
    for (ConvexEdge& edge : edges_) {
        for (const int end : {0, 1}) {
            edge.goesOn[end] = normals[edge.ends[end]].size() < 3;
            edge.endsFine[end] = isFine[edge.ends[end]];
        }
        lines_.push_back(lineOf(edge));
    }
    std::vector<Ball> cornerSpheres;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (normals[v].size() < 3) continue;
        corners_.push_back(static_cast<std::int32_t>(v));
        cornerSpheres.push_back({points_.col(v), 0.0});
    }
    isConvex_ = isConvexWithFewCorners();
    cornerTree_ = SphereLaneTree(cornerSpheres);
    edgeTree_ = SphereLaneTree(edgeSpheres);
    creaseTree_ = SphereLaneTree(creaseSpheres);
}

bool ContactFeatures::isConvexWithFewCorners() const
{
    if (corners_.empty() || corners_.size() > kFewCorners) return false;
    double size = 0.0;
    for (const std::int32_t corner : corners_) size = std::max(size, points_.col(corner).norm());
    return std::ranges::all_of(edges_, [&](const ConvexEdge& edge) {
        return std::ranges::all_of(corners_, [&](std::int32_t corner) {
            const Vec3 fromEdge = Vec3(points_.col(corner)) - edge.start;
            return edge.faceNormal[0].dot(fromEdge) <= kBulges * size &&
                   edge.faceNormal[1].dot(fromEdge) <= kBulges * size;
        });
    });
}

bool ContactFeatures::cornerSupports(std::int32_t corner, const Vec3& normal, double slack) const
{
    for (std::uint32_t i = neighbourStart_[corner]; i < neighbourStart_[corner + 1]; ++i) {
        if (neighbours_[i].dot(normal) < -slack) return false;
    }
    return true;
}

Vec3 ContactFeatures::inwardOf(std::int32_t corner) const
{
    Vec3 inward = Vec3::Zero();
    for (std::uint32_t i = neighbourStart_[corner]; i < neighbourStart_[corner + 1]; ++i)
        inward += neighbours_[i];
    return inward;
}

bool edgeSupports(const ConvexEdge& edge, const Vec3& normal, double slack)
{
    return edge.intoFace[0].dot(normal) >= -slack && edge.intoFace[1].dot(normal) >= -slack;
}

}  // namespace scree
