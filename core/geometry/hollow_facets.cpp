#include "core/geometry/hollow_facets.h"

#include <algorithm>

#include "core/geometry/mesh_fans.h"

namespace scree {
namespace {

/// Sines of smaller angles are none, and cosines of larger ones are edges, no hollow.
constexpr double kFlat = 1e-4, kEdge = 0.7;

/// What is wider than the hollow by more than this share does not lie in it.
constexpr double kFits = 1.1;

/// A polygon advances by its chords: a quarter of the bulge of facets makes that the radius of the
/// circle around it.
constexpr double kOfBulge = 0.25;

/// The corner of a triangle that is none of these two.
Vec3 cornerBeside(const TriMesh& mesh, std::int32_t triangle, int v, int w)
{
    for (const int corner : mesh.triangles.col(triangle)) {
        if (corner != v && corner != w) return mesh.points.col(corner);
    }
    return mesh.points.col(v);
}

}  // namespace

HollowFacets::HollowFacets(const TriMesh& mesh)
{
    const MeshFans fans(mesh);
    std::vector<Bend> bends(static_cast<std::size_t>(fans.triangleCount()));
    bool bendsAnywhere = false;
    for (std::int32_t f = 0; f < fans.triangleCount(); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        const Vec3 n = corners.normal();
        for (int k = 0; k < 3; ++k) {
            const std::int32_t other = fans.beyond(f)[k];
            if (other < 0) continue;
            const int v = mesh.triangles((k + 1) % 3, f), w = mesh.triangles((k + 2) % 3, f);
            const Vec3 start = mesh.points.col(v);
            const Vec3 along = (mesh.points.col(w) - start).normalized();
            const Vec3 beyond = cornerBeside(mesh, other, v, w) - start;
            const Vec3 otherNormal = cornersOf(mesh, other).normal();
            const double cosine = n.dot(otherNormal), sine = n.cross(otherNormal).norm();
            if (!(n.dot(beyond) > 0.0) || sine < kFlat || cosine < kEdge) continue;
            const double own = along.cross(corners[k] - start).norm();
            const double others = along.cross(beyond).norm();
            const double ofWidth = 0.5 * (1.0 + cosine) / sine;
            const auto least = static_cast<float>(ofWidth * std::min(own, others));
            Bend& bend = bends[f];
            if (bend.least > 0.0f && least >= bend.least) continue;
            bend = {n.cross(along).cast<float>(), least,
                    static_cast<float>(ofWidth * std::max(own, others))};
            bendsAnywhere = true;
        }
    }
    if (bendsAnywhere) bends_ = std::move(bends);
}

bool HollowFacets::isFittedBy(std::int32_t triangle, const Mat3& advance, double bulge) const
{
    const Bend& bend = bends_[triangle];
    const Vec3 across = bend.across.cast<double>();
    const double radius = across.dot(advance * across);
    return bend.least > 0.0f && radius + kOfBulge * bulge > bend.least &&
           radius < kFits * bend.most;
}

}  // namespace scree
