// Symbols: m middle of the axis in the frame of the mesh, a half the axis, s place on it from -1 to
//          1, e place of the mesh, d way from there to the axis.
#include "core/collision/capsule_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/collision/ball_contacts.h"
#include "core/geometry/distance_lanes.h"
#include "core/math/lanes.h"

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The axis of a capsule in the frame of a mesh.
struct Axis {
    Vec3 m, a;

    Vec3 at(double s) const { return m + s * a; }
    double nearestTo(const Vec3& p) const { return (p - m).dot(a) / a.squaredNorm(); }
};

/// Lower bound of the distance between the axis and the solid [m]: in pieces, none of which is
/// longer than the capsule is thick.
double apartAtLeast(const Axis& axis, double radius, const SignedDistance& field)
{
    const double length = axis.a.norm();
    const int pieces = std::clamp(static_cast<int>(std::ceil(length / radius)), 1, 16);
    double least = kInfinity;
    for (int i = 0; i < pieces; ++i) {
        const double s = (2.0 * i + 1.0) / pieces - 1.0;
        least = std::min(least, field.lowerBound(axis.at(s)));
    }
    return least - length / pieces;
}

/// Which of eight spheres come within `reach` of the axis.
class NearAxis {
public:
    NearAxis(const Axis& axis, double reach, double extent)
        : m_(FloatLanes3::all(axis.m)),
          a_(FloatLanes3::all(axis.a)),
          perLength_(FloatLanes3::all(axis.a / axis.a.squaredNorm())),
          reach_(floatLanesOf(reach + kSinglePrecision * (extent + axis.m.norm() + axis.a.norm())))
    {
    }

    unsigned operator()(const SphereLanes& spheres) const
    {
        const FloatLanes one = floatLanesOf(1.0);
        FloatLanes3 between = spheres.centre;
        between -= m_;
        const FloatLanes s = maxOf(-one, minOf(one, dot(between, perLength_)));
        between -= {s * a_.x, s * a_.y, s * a_.z};
        const FloatLanes within = reach_ + spheres.radius;
        return bitsOf(dot(between, between) < within * within);
    }

private:
    FloatLanes3 m_, a_, perLength_;
    FloatLanes reach_;
};

bool isBetweenEnds(double s)
{
    return -1.0 < s && s < 1.0;
}

bool comesInside(const Axis& axis, const Shape& mesh, double tolerance)
{
    for (const double s : {-1.0, 1.0}) {
        if (mesh.distance.value(axis.at(s)) <= tolerance) return true;
    }
    const double length = axis.a.norm();
    return mesh.rays
        .firstHit(axis.at(-1.0), axis.a / length, 2.0 * length, SurfaceRays::Facing::any)
        .has_value();
}

void findAtEnds(const Axis& axis, double radius, const Shape& mesh, double reach,
                CapsulePlaces& found)
{
    for (const int end : {0, 1}) {
        const double s = end == 0 ? -1.0 : 1.0;
        findBallContacts({axis.at(s), radius}, mesh, reach, found.ofEnd[end]);
        // What is nearer to the side than to the end by far is told in between.
        std::erase_if(found.ofEnd[end], [&](const BallContact& one) {
            return s * one.contact.normal.dot(axis.a) > kSupportSlack * axis.a.norm();
        });
    }
}

/// Where the sides of a capsule touch an edge or a corner of the mesh.
class BetweenEnds {
public:
    BetweenEnds(const Axis& axis, double radius, const ContactFeatures& features, double reach,
                std::vector<CapsulePlace>& found)
        : axis_(axis), radius_(radius), features_(features), reach_(reach), found_(found)
    {
    }

    void addEdge(std::int32_t index)
    {
        const ConvexEdge& edge = features_.edges()[index];
        const Vec3 between = edge.start - axis_.m;
        const double along = edge.direction.dot(axis_.a);
        const double determinant = axis_.a.squaredNorm() - along * along;
        if (!(determinant > 0.0)) return;
        const double s = (axis_.a - along * edge.direction).dot(between) / determinant;
        const double t = edge.direction.dot(s * axis_.a - between);
        if (!isBetweenEnds(s) || t < 0.0 || t > edge.length) return;
        const auto contact = contactAt(s, edge.start + t * edge.direction);
        if (!contact || !edgeSupports(edge, -contact->normal)) return;
        const auto [low, high] = std::minmax(edge.ends[0], edge.ends[1]);
        found_.push_back({{ContactPart::Kind::edge, index}, {low + 1, high + 1}, *contact});
    }

    void addCorner(std::int32_t corner)
    {
        const Vec3 e = features_.points().col(corner);
        const double s = axis_.nearestTo(e);
        if (!isBetweenEnds(s)) return;
        const auto contact = contactAt(s, e);
        if (!contact || !features_.cornerSupports(corner, -contact->normal)) return;
        found_.push_back({{ContactPart::Kind::corner, corner}, {corner + 1, corner + 1}, *contact});
    }

private:
    std::optional<FeatureContact> contactAt(double s, const Vec3& e) const
    {
        const Vec3 d = axis_.at(s) - e;
        const double gap = d.norm() - radius_;
        if (gap >= reach_) return {};
        const Vec3 n = d.normalized();
        return FeatureContact{axis_.at(s) - radius_ * n, n, gap};
    }

    const Axis& axis_;
    double radius_;
    const ContactFeatures& features_;
    double reach_;
    std::vector<CapsulePlace>& found_;
};

double nearestOf(const CapsulePlaces& found, double reach)
{
    double nearest = reach;
    for (const auto& ofEnd : found.ofEnd) {
        for (const BallContact& one : ofEnd) nearest = std::min(nearest, one.contact.gap);
    }
    for (const CapsulePlace& one : found.between) nearest = std::min(nearest, one.contact.gap);
    return nearest;
}

}  // namespace

std::optional<double> findCapsulePlaces(const RelativePair& pair, double reach,
                                        CapsulePlaces& found)
{
    for (auto& ofEnd : found.ofEnd) ofEnd.clear();
    found.between.clear();
    const double radius = pair.first.capsule.radius;
    const Shape& mesh = pair.second;
    const Axis axis{pair.translation, pair.rotation * pair.first.capsule.half};
    const double apart = apartAtLeast(axis, radius, mesh.distance) - radius;
    if (apart >= reach) return apart;
    if (comesInside(axis, mesh, kSharpness * radius)) return {};

    findAtEnds(axis, radius, mesh, reach, found);
    const ContactFeatures& features = mesh.features;
    BetweenEnds between(axis, radius, features, reach, found.between);
    const NearAxis isNear(axis, radius + reach, mesh.boundingRadius);
    features.edgeTree().visit(
        isNear, [&](std::uint32_t edge, int) { between.addEdge(static_cast<std::int32_t>(edge)); });
    features.cornerTree().visit(
        isNear, [&](std::uint32_t which, int) { between.addCorner(features.corners()[which]); });
    return nearestOf(found, reach);
}

}  // namespace scree
