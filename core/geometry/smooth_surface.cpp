#include "core/geometry/smooth_surface.h"

#include "core/geometry/facing_weights.h"
#include "core/geometry/round_place.h"

namespace scree {
namespace {

constexpr int kMostSteps = 3;  // triangles  [A40]

/// Volume that three normals span below which they lie in one plane.
constexpr double kSameNormals = 1e-12;

}  // namespace

SmoothSurface::SmoothSurface(const TriMesh& mesh) : mesh_(mesh), fans_(mesh)
{
    // Normals weigh by the angles of their triangles at the vertex.
    normals_.setZero(3, mesh.points.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        const Vec3 normal = corners.normal();
        for (int k = 0; k < 3; ++k)
            normals_.col(mesh.triangles(k, f)) += corners.angleAt(k) * normal;
    }
    for (auto normal : normals_.colwise()) normal.normalize();
}

std::optional<Vec3> SmoothSurface::weightsFacing(std::int32_t triangle, const Vec3& direction) const
{
    Mat3 normals;
    for (int k = 0; k < 3; ++k) normals.col(k) = normals_.col(mesh_.triangles(k, triangle));
    for (int k = 0; k < 3; ++k) {
        if (normals.col(k).dot(normals.col((k + 1) % 3)) < kFineTurn) return std::nullopt;
    }
    const std::optional<FacingWeights> found = facingWeights(normals, direction, kSameNormals);
    if (!found) return std::nullopt;
    return found->weights;
}

std::optional<Vec3> SmoothSurface::placeFacing(std::int32_t vertex, const Vec3& direction) const
{
    if (isEmpty()) return std::nullopt;
    // Begin with the triangle around the vertex that is left least.
    std::int32_t triangle = -1;
    std::optional<Vec3> weights;
    for (const std::int32_t around : fans_.around(vertex)) {
        const std::optional<Vec3> here = weightsFacing(around, direction);
        if (!here || (weights && here->minCoeff() <= weights->minCoeff())) continue;
        weights = here;
        triangle = around;
    }
    for (int step = 0; weights; ++step) {
        Eigen::Index leaving = 0;
        if (weights->minCoeff(&leaving) >= kOutsideFacet) {
            Vec3 place = Vec3::Zero();
            for (int k = 0; k < 3; ++k) {
                place += (*weights)[k] * mesh_.points.col(mesh_.triangles(k, triangle));
            }
            return place;
        }
        if (step == kMostSteps) break;
        triangle = fans_.beyond(triangle)[leaving];
        weights = weightsFacing(triangle, direction);
    }
    return std::nullopt;
}

}  // namespace scree
