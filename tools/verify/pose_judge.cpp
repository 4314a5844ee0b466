#include "tools/verify/pose_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
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
        samples = sampleFaces(mesh, kSampleSpacing * box.longestEdge());
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

    /// Depth of a point of the artist's frame, if it is more than `least`; else 0.
    double depthAt(const Vec3& p, double least = 0.0) const
    {
        if (isGround) return std::max(0.0, centre.y() - p.y());
        std::size_t index = 0;
        for (int k = 2; k >= 0; --k) {
            const double place = (p[k] - box.min[k]) / cell;
            if (!(place >= 0.0 && place < counts[k])) return 0.0;
            index = index * counts[k] + static_cast<std::size_t>(place);
        }
        // A little for rounding.
        const double away = 1.001 * (p - centreOfCell(index)).norm();
        if (away - distances[index] <= least) return 0.0;
        const double depth = -signedDistance(p);
        return depth > least ? depth : 0.0;
    }

    TriMesh mesh;
    Aabb box;
    Vec3 centre;
    bool isGround;
    double radius = 0.0;  // around centre
    std::vector<Vec3> samples;
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

double PoseJudge::depthIn(const SceneFrame& frame, std::size_t body, const Vec3& point) const
{
    return solidOf(body).depthAt(inverse(frame.worldFromAsset[body]) * point);
}

double PoseJudge::shortestEdge(std::size_t body) const
{
    return solidOf(body).box.shortestEdge();
}

}  // namespace scree::verify
