#include "core/geometry/smooth_surface.h"

#include <Eigen/LU>

#include <map>
#include <utility>

#include "core/math/rotation.h"

namespace scree {
namespace {

/// Corner normals of a facet closer together than 20° (this is the cosine) make it part of a round
/// surface. Beyond, as on a ring of ten points around its tube (36°), a facet lies flat on the
/// ground and holds the body: taken for round it would roll off.
constexpr double kFineFacet = 0.93969262078590838;

constexpr int kMostSteps = 3;  // triangles  [A40]

constexpr double kOnEdge = -1e-9;  // a corner weight above this is not outside

}  // namespace

SmoothSurface::SmoothSurface(const TriMesh& mesh) : mesh_(mesh)
{
    const Eigen::Index vertexCount = mesh.points.cols(), triangleCount = mesh.triangles.cols();
    normals_.setZero(3, vertexCount);
    fanStart_.assign(static_cast<std::size_t>(vertexCount) + 1, 0);
    std::map<std::pair<int, int>, std::pair<std::int32_t, int>> cornerOfEdge;
    beyond_.assign(static_cast<std::size_t>(triangleCount), {-1, -1, -1});
    for (Eigen::Index f = 0; f < triangleCount; ++f) {
        const auto point = [&](int k) -> Vec3 { return mesh.points.col(mesh.triangles(k % 3, f)); };
        const Vec3 normal = (point(1) - point(0)).cross(point(2) - point(0)).normalized();
        const auto triangle = static_cast<std::int32_t>(f);
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.triangles(k, f);
            normals_.col(v) +=
                angleBetween(point(k + 1) - point(k), point(k + 2) - point(k)) * normal;
            ++fanStart_[static_cast<std::size_t>(v) + 1];

            const auto edge =
                std::minmax(mesh.triangles((k + 1) % 3, f), mesh.triangles((k + 2) % 3, f));
            const auto [other, isNew] = cornerOfEdge.try_emplace(edge, triangle, k);
            if (isNew) continue;
            beyond_[f][k] = other->second.first;
            beyond_[other->second.first][other->second.second] = triangle;
        }
    }
    for (Eigen::Index v = 0; v < vertexCount; ++v) {
        const Vec3 sum = normals_.col(v);
        normals_.col(v) = sum.normalized();
    }

    for (std::size_t v = 0; v + 1 < fanStart_.size(); ++v) fanStart_[v + 1] += fanStart_[v];
    fan_.resize(static_cast<std::size_t>(3 * triangleCount));
    std::vector<std::int32_t> next(fanStart_.begin(), fanStart_.end() - 1);
    for (Eigen::Index f = 0; f < triangleCount; ++f) {
        for (int k = 0; k < 3; ++k) {
            fan_[next[mesh.triangles(k, f)]++] = static_cast<std::int32_t>(f);
        }
    }
}

std::optional<Vec3> SmoothSurface::weightsFacing(std::int32_t triangle, const Vec3& direction) const
{
    Mat3 normals;
    for (int k = 0; k < 3; ++k) normals.col(k) = normals_.col(mesh_.triangles(k, triangle));
    for (int k = 0; k < 3; ++k) {
        if (normals.col(k).dot(normals.col((k + 1) % 3)) < kFineFacet) return std::nullopt;
    }
    Mat3 inverse;
    bool isInvertible = false;
    normals.computeInverseWithCheck(inverse, isInvertible, 1e-12);
    if (!isInvertible) return std::nullopt;
    const Vec3 weights = inverse * direction;
    const double sum = weights.sum();
    if (!(sum > 0.0)) return std::nullopt;
    return weights / sum;
}

std::optional<Vec3> SmoothSurface::placeFacing(std::int32_t vertex, const Vec3& direction) const
{
    if (isEmpty()) return std::nullopt;
    // Begin with the triangle around the vertex that is left least.
    std::int32_t triangle = -1;
    std::optional<Vec3> weights;
    for (std::int32_t i = fanStart_[vertex]; i < fanStart_[vertex + 1]; ++i) {
        const std::optional<Vec3> here = weightsFacing(fan_[i], direction);
        if (!here || (weights && here->minCoeff() <= weights->minCoeff())) continue;
        weights = here;
        triangle = fan_[i];
    }
    for (int step = 0; weights; ++step) {
        Eigen::Index leaving = 0;
        if (weights->minCoeff(&leaving) >= kOnEdge) {
            Vec3 place = Vec3::Zero();
            for (int k = 0; k < 3; ++k) {
                place += (*weights)[k] * mesh_.points.col(mesh_.triangles(k, triangle));
            }
            return place;
        }
        if (step == kMostSteps) break;
        triangle = beyond_[triangle][leaving];
        weights = weightsFacing(triangle, direction);
    }
    return std::nullopt;
}

}  // namespace scree
