#include "tools/verify/pose_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/mesh_edges.h"
#include "core/geometry/surface_rays.h"
#include "core/geometry/triangle_distance.h"
#include "core/geometry/winding_number.h"
#include "core/math/point_box.h"

namespace scree::verify {
namespace {

/// Samples lie no farther apart than this part of the longest edge of the box.
constexpr double kSampleSpacing = 1.0 / 30.0;

constexpr int kCells = 64;  // along the longest edge, to tell at once how deep a point may be

TriMesh toTriMesh(const SceneMesh& mesh)
{
    TriMesh result;
    result.points = mesh.points;
    result.triangles = mesh.triangles;
    return result;
}

/// Corners and a grid of points on every triangle.
std::vector<Vec3> sampleFaces(const TriMesh& mesh, double spacing)
{
    std::vector<Vec3> samples;
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) samples.push_back(mesh.points.col(v));
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto [a, b, c] = cornersOf(mesh, f);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const int n = std::max(2, static_cast<int>(std::ceil(longest / spacing)));
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                const bool isCorner = i == n || j == n || i + j == 0;
                if (isCorner) continue;
                samples.push_back(a + (b - a) * (static_cast<double>(i) / n) +
                                  (c - a) * (static_cast<double>(j) / n));
            }
        }
    }
    return samples;
}

struct Segment {
    Vec3 a, b;
};

/// Edges longer than the samples are apart at which the surface bends: those across a flat face are
/// sampled with it.
std::vector<Segment> bentEdges(const TriMesh& mesh, double spacing)
{
    constexpr double kBend = 1e-6;  // sine of an angle
    std::vector<Segment> edges;
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        const auto normal = [&](const TriangleSide& side) {
            return cornersOf(mesh, side.triangle).normal().normalized();
        };
        const bool isBent = sides.size() != 2 ||
                            normal(sides[0]).cross(normal(sides[1])).norm() > kBend ||
                            normal(sides[0]).dot(normal(sides[1])) < 0.0;
        const Segment edge{mesh.points.col(sides[0].low), mesh.points.col(sides[0].high)};
        if (isBent && (edge.b - edge.a).norm() > spacing) edges.push_back(edge);
    });
    return edges;
}

}  // namespace

struct PoseJudge::Solid {
    explicit Solid(const SceneMesh& source)
        : mesh(toTriMesh(source)),
          box(boxOf(mesh.points)),
          centre(box.centre()),
          isGround(mesh.triangles.cols() == 2)
    {
        for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
            radius = std::max(radius, (Vec3(mesh.points.col(v)) - centre).norm());
        }
        if (isGround) return;
        spacing = kSampleSpacing * box.longestEdge();
        samples = sampleFaces(mesh, spacing);
        edges = bentEdges(mesh, spacing);
        rays = SurfaceRays(mesh);
        winding = std::make_unique<WindingNumber>(mesh);
        measureCells();
    }

    /// Negative inside. Nothing of the surface lies between a point and what is closest to it, so
    /// where that is inside a face, the face tells the side.
    double signedDistance(const Vec3& p) const
    {
        const TriangleCorners corners = cornersOf(mesh, rays.closestTriangle(p));
        const auto [q, feature] = closestOnTriangle(p, corners);
        const bool isInside = feature == TriangleFeature::face ? corners.normal().dot(p - q) < 0.0
                                                               : winding->at(p) > 0.5;
        return isInside ? -(p - q).norm() : (p - q).norm();
    }

    Vec3 centreOfCell(std::size_t i) const
    {
        const auto x = static_cast<double>(i % counts[0]);
        const auto y = static_cast<double>(i / counts[0] % counts[1]);
        const auto z = static_cast<double>(i / counts[0] / counts[1]);
        return box.min + cell * Vec3(x + 0.5, y + 0.5, z + 0.5);
    }

    void measureCells()
    {
        cell = box.longestEdge() / kCells;
        for (int k = 0; k < 3; ++k) {
            counts[k] = std::max(1, static_cast<int>(std::ceil(box.size()[k] / cell)));
        }
        distances.resize(static_cast<std::size_t>(counts[0]) * counts[1] * counts[2]);
        parallelFor(distances.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                distances[i] = signedDistance(centreOfCell(i));
        });
    }

    /// A point is no deeper than this, which is negative for what is farther outside.
    double depthBound(const Vec3& p) const
    {
        const double outside = box.distanceTo(p);
        if (outside > 0.0) return -outside;
        std::size_t index = 0;
        for (int k = 2; k >= 0; --k) {
            const double place = std::clamp((p[k] - box.min[k]) / cell, 0.0, counts[k] - 0.5);
            index = index * counts[k] + static_cast<std::size_t>(place);
        }
        // A little for rounding.
        return 1.001 * (p - centreOfCell(index)).norm() - distances[index];
    }

    /// Depth of a point of the artist's frame, if it is more than `least`; else 0.
    double depthAt(const Vec3& p, double least = 0.0) const
    {
        if (isGround) return std::max(0.0, centre.y() - p.y());
        if (depthBound(p) <= least) return 0.0;
        const double depth = -signedDistance(p);
        return depth > least ? depth : 0.0;
    }

    /// The same of the deepest point of a segment of the artist's frame. Two edges that cross meet
    /// at points, which samples miss: the segment is halved where it may be deeper than `least`,
    /// and in pieces as short as samples are `apart` the deepest place is searched for, which is
    /// one, where what they lie in is convex.
    double depthOn(const Segment& segment, double least, double apart) const
    {
        if (isGround) return 0.0;  // its ends are the deepest, and are samples
        const Vec3 way = segment.b - segment.a, middle = segment.a + 0.5 * way;
        const double length = way.norm();
        if (depthBound(middle) + 0.5 * length <= least) return 0.0;
        const double atMiddle = -signedDistance(middle);
        if (atMiddle + 0.5 * length <= least) return 0.0;
        double deepest = std::max(least, atMiddle);
        if (length > apart) {
            deepest = std::max(deepest, depthOn({segment.a, middle}, deepest, apart));
            deepest = std::max(deepest, depthOn({middle, segment.b}, deepest, apart));
        } else {
            const double flat = 1e-7 * length;  // what lies on a face has no peak
            const bool isFlat = std::abs(atMiddle + signedDistance(segment.a)) <= flat &&
                                std::abs(atMiddle + signedDistance(segment.b)) <= flat;
            if (!isFlat) deepest = std::max(deepest, deepestPlace(segment, way, deepest));
        }
        return deepest > least ? deepest : 0.0;
    }

    /// By golden sections, as long as it may be deeper than `least`.
    double deepestPlace(const Segment& segment, const Vec3& way, double least) const
    {
        constexpr double kGolden = 0.6180339887498949;
        constexpr int kMostSections = 20;
        const auto at = [&](double s) { return -signedDistance(segment.a + s * way); };
        const double length = way.norm();
        double low = 0.0, high = 1.0, left = 1.0 - kGolden, right = kGolden;
        double atLeft = at(left), atRight = at(right);
        for (int i = 0; i < kMostSections; ++i) {
            if (std::max(atLeft, atRight) + (high - low) * length <= least) break;
            if (atLeft < atRight) {
                low = left;
                left = std::exchange(right, low + kGolden * (high - low));
                atLeft = std::exchange(atRight, at(right));
            } else {
                high = right;
                right = std::exchange(left, high - kGolden * (high - low));
                atRight = std::exchange(atLeft, at(left));
            }
        }
        return std::max(atLeft, atRight);
    }

    TriMesh mesh;
    Aabb box;
    Vec3 centre;
    bool isGround;
    double radius = 0.0;   // around centre
    double spacing = 0.0;  // of samples, at most [m]
    std::vector<Vec3> samples;
    std::vector<Segment> edges;
    SurfaceRays rays;
    std::unique_ptr<WindingNumber> winding;
    double cell = 0.0;
    std::array<int, 3> counts = {};
    std::vector<double> distances;  // of the centres of cells, negative inside [m]
};

PoseJudge::PoseJudge(const SceneDescription& scene)
{
    for (const SceneMesh& mesh : scene.meshes) solids_.push_back(std::make_unique<Solid>(mesh));
    for (const SceneBody& body : scene.bodies) {
        meshOf_.push_back(body.mesh);
        moves_.push_back(body.moves);
    }
}

PoseJudge::~PoseJudge() = default;

bool PoseJudge::areNear(const SceneFrame& frame, std::size_t a, std::size_t b) const
{
    if (solidOf(a).isGround) return areNear(frame, b, a);
    const Solid &solidA = solidOf(a), &solidB = solidOf(b);
    const Vec3 centre = frame.worldFromAsset[a] * solidA.centre;
    const Vec3 fromB = inverse(frame.worldFromAsset[b]) * centre - solidB.centre;
    if (solidB.isGround) return fromB.y() < solidA.radius;
    return fromB.norm() < solidA.radius + solidB.radius;
}

double PoseJudge::deepest(const SceneFrame& frame, std::size_t a, std::size_t b) const
{
    const auto into = [&](std::size_t from, std::size_t to) {
        const Pose relative = inverse(frame.worldFromAsset[to]) * frame.worldFromAsset[from];
        double depth = 0.0;
        for (const Vec3& p : solidOf(from).samples) {
            depth = std::max(depth, solidOf(to).depthAt(relative * p, depth));
        }
        for (const auto& [p, q] : solidOf(from).edges) {
            depth = std::max(depth, solidOf(to).depthOn({relative * p, relative * q}, depth,
                                                        solidOf(from).spacing));
        }
        return depth;
    };
    return std::max(into(a, b), into(b, a));
}

std::vector<Overlap> PoseJudge::overlaps(const SceneFrame& frame) const
{
    std::vector<Overlap> pairs;
    for (std::size_t a = 0; a < meshOf_.size(); ++a) {
        for (std::size_t b = a + 1; b < meshOf_.size(); ++b) {
            if (!moves_[a] && !moves_[b]) continue;
            if (areNear(frame, a, b)) pairs.push_back({a, b, 0.0});
        }
    }
    parallelFor(pairs.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            pairs[i].depth = deepest(frame, pairs[i].a, pairs[i].b);
        }
    });
    std::erase_if(pairs, [](const Overlap& pair) { return pair.depth == 0.0; });
    return pairs;
}

double PoseJudge::deepestOverlap(const SceneFrame& frame) const
{
    double deepest = 0.0;
    for (const Overlap& pair : overlaps(frame)) deepest = std::max(deepest, pair.depth);
    return deepest;
}

double PoseJudge::depthIn(const SceneFrame& frame, std::size_t body, const Vec3& point) const
{
    return solidOf(body).depthAt(inverse(frame.worldFromAsset[body]) * point);
}

double PoseJudge::shortestEdge(std::size_t body) const
{
    return solidOf(body).box.shortestEdge();
}

}  // namespace scree::verify
