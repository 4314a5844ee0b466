// Symbols: phi signed distance, h node spacing of the field.
#include "core/geometry/surface_normal.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace scree {
namespace {

/// Below this length of the gradient the point lies near the medial axis and the field has no say.
/// [A5]
constexpr double kMedialAxis = 0.1;

/// Within this fraction of h of two faces, a hit counts as a hit of their edge. [A6] Single
/// precision places rays to about 1e-6 h.
constexpr double kEdgeHit = 1e-5;

/// A way that crosses the surface is looked for this fraction of h before and beyond its ends.
constexpr double kCrossingSlack = 1e-2;

Vec3 closestPoint(const TriMesh& mesh, int triangle, const Vec3& point)
{
    return closestOnTriangle(point, cornersOf(mesh, triangle)).point;
}

/// Away from the solid, whichever side the point is on; the face's normal when it lies on the
/// surface.
Vec3 directionFromClosest(const Shape& shape, const Vec3& point)
{
    const int triangle = shape.rays.closestTriangle(point);
    const Vec3 away = point - closestPoint(shape.mesh, triangle, point);
    const double distance = away.norm();
    if (distance < 1e-9 * shape.boundingRadius) return cornersOf(shape.mesh, triangle).normal();
    return (shape.distance.value(point) < 0.0 ? -1.0 : 1.0) / distance * away;
}

/// Faces that meet at a hit share it by angle and by how fast the other body runs into them.
///
/// Departs from A6, which averages by angle unless a face is separating: a block at rest runs into
/// the faces beside its corners with 1e-12 m/s of rounding, and half of a sideways normal from that
/// throws it about. Weighted by speed the rule is the same for the clear cases and continuous
/// between.
Vec3 sharedNormal(const std::vector<NearFace>& faces, const Vec3& approach, const Vec3& hitNormal)
{
    Vec3 bySpeed = Vec3::Zero(), byAngle = Vec3::Zero();
    for (const NearFace& face : faces) {
        bySpeed += face.angle * std::max(0.0, -approach.dot(face.normal)) * face.normal;
        byAngle += face.angle * face.normal;
    }
    constexpr double kRounding = 1e-12;
    if (const double length = bySpeed.norm(); length > kRounding * approach.norm())
        return bySpeed / length;
    if (const double length = byAngle.norm(); length > kRounding) return byAngle / length;
    return hitNormal;
}

struct SurfaceHit {
    int triangle;
    Vec3 place;
};

/// The face that the point crosses between `from` and `to`, looked for from a little before to a
/// little beyond, so that a point lying on the surface still sees it.
///
/// The nearest face of a point just below an edge is a coin toss between top and side; in a stack
/// of aligned cubes whose vertices and edges coincide within micrometres half of the answers pushed
/// sideways and the stack shuffled along at 2 cm/s. The face actually crossed is no coin toss. [A6]
std::optional<SurfaceHit> crossedFace(const Shape& shape, const Approach& approach, double slack)
{
    const Vec3 path = approach.to - approach.from;
    const double length = path.norm();
    if (length < 1e-9 * slack) return std::nullopt;
    const Vec3 direction = path / length;
    const Vec3 origin = approach.from - slack * direction;
    const auto hit =
        shape.rays.firstHit(origin, direction, length + 2.0 * slack, SurfaceRays::Facing::against);
    if (!hit) return std::nullopt;
    return SurfaceHit{hit->triangle, origin + hit->distance * direction};
}

/// Where a ray along the gradient leaves the solid, or from outside meets it; the closest face
/// where that misses.
SurfaceHit facedSurface(const Shape& shape, const Vec3& point, const Vec3& outward, double slack)
{
    const double phi = shape.distance.value(point);
    const double reach = std::abs(phi) + 2.0 * std::sqrt(3.0) * shape.distance.spacing();
    const bool inside = phi < 0.0;
    const Vec3 direction = inside ? outward : Vec3(-outward);
    const auto facing = inside ? SurfaceRays::Facing::along : SurfaceRays::Facing::against;
    const Vec3 origin = point - slack * direction;
    if (const auto hit = shape.rays.firstHit(origin, direction, slack + reach, facing)) {
        return {hit->triangle, origin + hit->distance * direction};
    }
    const int triangle = shape.rays.closestTriangle(point);
    return {triangle, closestPoint(shape.mesh, triangle, point)};
}

Vec3 gradientDirection(const Shape& shape, const Vec3& point)
{
    const Vec3 gradient = shape.distance.gridGradient(point);
    const double length = gradient.norm();
    return length < kMedialAxis ? directionFromClosest(shape, point) : Vec3(gradient / length);
}

Vec3 trueNormal(const Shape& shape, const Approach& approach)
{
    const double slack = kCrossingSlack * shape.distance.spacing();
    std::optional<SurfaceHit> hit = crossedFace(shape, approach, slack);
    if (!hit) {
        hit = facedSurface(shape, approach.point, gradientDirection(shape, approach.point), slack);
    }
    const Vec3 normal = cornersOf(shape.mesh, hit->triangle).normal();
    thread_local std::vector<NearFace> faces;
    faces.clear();
    shape.distance.facesNear(hit->place, kEdgeHit * shape.distance.spacing(), faces);
    return faces.size() > 1 ? sharedNormal(faces, approach.velocity, normal) : normal;
}

/// The face that is crossed, or that is nearest; where several meet they share.
Vec3 exactNormal(const ExactSolid& solid, double spacing, const Approach& approach)
{
    if (solid.form() == ExactSolid::Form::plane) return Vec3::UnitY();
    if (solid.form() == ExactSolid::Form::sphere) return solid.gradient(approach.point);
    const Vec3 outward = solid.gradient(approach.point);
    const Vec3 place = solid.entry(approach.from, approach.to, kCrossingSlack * spacing)
                           .value_or(approach.point - solid.value(approach.point) * outward);
    thread_local std::vector<NearFace> faces;
    faces.clear();
    solid.facesNear(place, kEdgeHit * spacing, faces);
    if (faces.empty()) return outward;
    return faces.size() > 1 ? sharedNormal(faces, approach.velocity, outward) : faces[0].normal;
}

}  // namespace

Vec3 surfaceNormal(const Shape& shape, const Approach& approach)
{
    if (const ExactSolid* solid = shape.distance.solid()) {
        return exactNormal(*solid, shape.distance.spacing(), approach);
    }
    return shape.usesTrueNormals ? trueNormal(shape, approach)
                                 : gradientDirection(shape, approach.point);
}

}  // namespace scree
