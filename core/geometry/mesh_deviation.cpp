#include "core/geometry/mesh_deviation.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/surface_rays.h"
#include "core/geometry/triangle_distance.h"
#include "core/geometry/winding_number.h"
#include "core/math/point_box.h"

namespace scree {
namespace {

constexpr double kLooksAlongTheBox = 64.0;

/// Calls visit(p) for the corners of a triangle and for points within it, at most `spacing` apart.
template <class Visit>
void visitPoints(const TriMesh& mesh, Eigen::Index triangle, double spacing, const Visit& visit)
{
    const auto corner = [&](int k) -> Vec3 {
        return mesh.points.col(mesh.triangles(k % 3, triangle));
    };
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (corner(k + 1) - corner(k)).norm());
    const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    const Vec3 u = (corner(1) - corner(0)) / steps, v = (corner(2) - corner(0)) / steps;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) visit((corner(0) + i * u + j * v).eval());
    }
}

/// Takes over what lies farther from `surface` than what is known, and is looked at.
template <class IsLookedAt>
void look(const TriMesh& from, const TriMesh& surface, bool isFirst, MeshDeviation& farthest,
          const IsLookedAt& isLookedAt)
{
    const SurfaceRays rays(surface);
    const double spacing = boxOf(from.points).longestEdge() / kLooksAlongTheBox;
    for (Eigen::Index t = 0; t < from.triangles.cols(); ++t) {
        visitPoints(from, t, spacing, [&](const Vec3& p) {
            const Vec3 closest =
                closestOnTriangle(p, cornersOf(surface, rays.closestTriangle(p))).point;
            const double distance = (p - closest).norm();
            if (distance > farthest.distance && isLookedAt(t, p)) farthest = {distance, p, isFirst};
        });
    }
}

bool always(Eigen::Index, const Vec3&)
{
    return true;
}

}  // namespace

MeshDeviation farthestApart(const TriMesh& a, const TriMesh& b)
{
    MeshDeviation farthest;
    look(a, b, true, farthest, always);
    look(b, a, false, farthest, always);
    return farthest;
}

MeshDeviation farthestApartInSight(const TriMesh& drawn, const TriMesh& solid)
{
    constexpr double kBefore = 1e-6;  // a face, of the box
    constexpr double kWithin = 0.75;  // beside a hole it is a half
    const WindingNumber winding(drawn);
    const double before = kBefore * boxOf(drawn.points).longestEdge();
    MeshDeviation farthest;
    look(drawn, solid, true, farthest, [&](Eigen::Index triangle, const Vec3& p) {
        const Vec3 out = cornersOf(drawn, triangle).areaVector().normalized();
        return winding.at(p + before * out) < kWithin;
    });
    look(solid, drawn, false, farthest, always);
    return farthest;
}

}  // namespace scree
