#include "tools/verify/pose_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

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

/// The largest value between two places of a function with one peak there, by golden sections.
template <class Function>
double highest(const Function& at, double low, double high)
{
    constexpr double kGolden = 0.6180339887498949;
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double leftValue = at(left), rightValue = at(right);
    for (int i = 0; i < 20; ++i) {
        if (leftValue < rightValue) {
            low = left;
            left = right;
            leftValue = rightValue;
            right = low + kGolden * (high - low);
            rightValue = at(right);
        } else {
            high = right;
            right = left;
            rightValue = leftValue;
            left = high - kGolden * (high - low);
            leftValue = at(left);
        }
    }
    return std::max(leftValue, rightValue);
}

struct Segment {
    Vec3 a, b;
};

/// Edges at which the surface bends: those across a flat face are sampled with it.
std::vector<Segment> bentEdges(const TriMesh& mesh)
{
    constexpr double kBend = 1e-6;  // sine of an angle
    std::vector<Segment> edges;
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        const auto normal = [&](const TriangleSide& side) {
            return cornersOf(mesh, side.triangle).normal().normalized();
        };
        const bool isBent =
            sides.size() != 2 || normal(sides[0]).cross(normal(sides[1])).norm() > kBend ||
            normal(sides[0]).dot(normal(sides[1])) < 0.0;
        if (!isBent) return;
        edges.push_back({mesh.points.col(sides[0].low), mesh.points.col(sides[0].high)});
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
        edges = bentEdges(mesh);
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
    /// at points, which samples miss: between those of a segment the deepest place is searched
    /// for, which is one, where what it lies in is convex.
    double depthOn(const Segment& segment, double least, double apart) const
    {
        if (isGround) return 0.0;  // its ends are the deepest, and are samples
        const Vec3 way = segment.b - segment.a;
        const double length = way.norm();
        if (depthBound(segment.a + 0.5 * way) + 0.5 * length <= least) return 0.0;
        const auto at = [&](double s) { return -signedDistance(segment.a + s * way); };
        const int parts = std::max(2, static_cast<int>(std::ceil(length / apart)));
        const double part = 1.0 / parts;
        const double flat = 1e-7 * part * length;  // what lies on a face has no peak
        double before = at(0.0), here = before, deepest = std::max(least, here);
        for (int i = 0; i <= parts; ++i) {
            const double after = i < parts ? at((i + 1) * part) : here;
            const bool isPeak = here >= before && here >= after &&
                                here - std::min(before, after) > flat;
            if (isPeak && here + part * length > deepest) {
                const double low = std::max(0.0, (i - 1) * part);
                const double high = std::min(1.0, (i + 1) * part);
                deepest = std::max(deepest, highest(at, low, high));
            }
            before = here;
            here = after;
        }
        return deepest > least ? deepest : 0.0;
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
