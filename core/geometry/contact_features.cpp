#include "core/geometry/contact_features.h"

#include <algorithm>

#include "core/geometry/mesh_edges.h"

namespace scree {
namespace {

/// Sine of the bend below which an edge lies inside a flat region; and what is rounding of that.
constexpr double kFlat = 1e-3, kNoBend = 1e-7;

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

/// Numbers regions in which all faces look the same way as the first. Where a surface is cut finely
/// no two neighbours bend by as much as counts, but together they do: a lens of 40 000 triangles
/// had no feature at all on its dome, and sank by as much as that stands out.
std::vector<int> flatRegionsOf(const TriMesh& mesh, const MeshEdges& edges)
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    std::vector<Vec3> normals(count);
    for (std::size_t f = 0; f < count; ++f)
        normals[f] = cornersOf(mesh, static_cast<Eigen::Index>(f)).normal();
    std::vector<std::array<int, 3>> next(count, {-1, -1, -1});
    edges.forEach([&](std::span<const TriangleSide> sides) {
        next[sides[0].triangle][sides[0].corner] = sides[1].triangle;
        next[sides[1].triangle][sides[1].corner] = sides[0].triangle;
    });
    std::vector<int> regionOf(count, -1), open;
    int regions = 0;
    for (std::size_t first = 0; first < count; ++first) {
        if (regionOf[first] >= 0) continue;
        regionOf[first] = regions;
        open.assign(1, static_cast<int>(first));
        while (!open.empty()) {
            const int f = open.back();
            open.pop_back();
            for (const int g : next[f]) {
                if (regionOf[g] >= 0) continue;
                if ((normals[g] - normals[first]).squaredNorm() >= kFlat * kFlat) continue;
                regionOf[g] = regions;
                open.push_back(g);
            }
        }
        ++regions;
    }
    return regionOf;
}

void addOnce(std::vector<int>& known, int one)
{
    if (std::ranges::find(known, one) == known.end()) known.push_back(one);
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
    const MeshEdges meshEdges(mesh);
    const std::vector<int> regionOf = flatRegionsOf(mesh, meshEdges);
    std::vector<std::vector<Vec3>> around(points_.cols()), normals(points_.cols());
    std::vector<std::vector<int>> regions(points_.cols());
    std::vector<char> isFine(points_.cols(), 1);
    std::vector<Ball> edgeSpheres, creaseSpheres;
    bool isNotched = false;
    meshEdges.forEach([&](std::span<const TriangleSide> sides) {
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
            for (const int point : ends) {
                addDirection(normals[point], edge.faceNormal[side]);
                addOnce(regions[point], regionOf[sides[side].triangle]);
            }
        }
        // Convex: each face falls away behind the plane of the other.
        const double rises = edge.intoFace[1].dot(edge.faceNormal[0]);
        if (rises > kFlat && edge.faceNormal[0].dot(edge.faceNormal[1]) < kCrease) {
            creases_.push_back({start, direction, length, edge.faceNormal, edge.intoFace});
            creaseSpheres.push_back({0.5 * (start + end), 0.5 * length});
        }
        if (rises > kNotch || edge.faceNormal[0].dot(edge.faceNormal[1]) < kFine)
            for (const int point : ends) isFine[point] = 0;
        isNotched = isNotched || rises > kNotch;
        const bool isBorder = regionOf[sides[0].triangle] != regionOf[sides[1].triangle];
        if (rises > (isBorder ? -kNoBend : -kFlat)) return;
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
    const auto isCorner = [&](std::size_t point) {
        return std::max(normals[point].size(), regions[point].size()) > 2;
    };
    for (ConvexEdge& edge : edges_) {
        for (const int end : {0, 1}) {
            edge.goesOn[end] = !isCorner(static_cast<std::size_t>(edge.ends[end]));
            edge.endsFine[end] = isFine[edge.ends[end]];
        }
        lines_.push_back(lineOf(edge));
    }
    std::vector<Ball> cornerSpheres;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (!isCorner(v)) continue;
        corners_.push_back(static_cast<std::int32_t>(v));
        cornerSpheres.push_back({points_.col(v), 0.0});
    }
    // The walls of a cavity bend inward alone, and lie behind all faces outside.
    if (!isNotched && isConvexWithFewCorners()) findHullEdges();
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

void ContactFeatures::findHullEdges()
{
    const auto isSame = [](const Vec3& one, const Vec3& other) {
        return (one - other).squaredNorm() < kFlat * kFlat;
    };
    // Two faces of a convex solid meet on one line.
    const auto areBetweenSameFaces = [&](const ConvexEdge& one, const ConvexEdge& other) {
        const auto& [a, b] = one.faceNormal;
        const auto& [c, d] = other.faceNormal;
        return (isSame(a, c) && isSame(b, d)) || (isSame(a, d) && isSame(b, c));
    };
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const bool isKnown = std::ranges::any_of(hullEdges_, [&](std::int32_t known) {
            return areBetweenSameFaces(edges_[e], edges_[known]);
        });
        if (!isKnown) hullEdges_.push_back(static_cast<std::int32_t>(e));
    }
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
