// Symbols: a, b half segments of the first and second; c centre of the first; s, t places on them
//          from -1 to 1; n normal out of the second.
#include "core/collision/capsule_contacts.h"

#include <algorithm>
#include <limits>

namespace scree {
namespace {

/// Capsules that lie along each other touch at their ends. Where their segments are nearest counts
/// besides if it is nearer than all ends by this share of the smaller radius: in between that place
/// wanders far as they turn a little.
constexpr double kNearer = 1e-5;

struct Places {
    double s, t;
};

std::int32_t partAt(double s)
{
    return s == -1.0 ? 1 : s == 1.0 ? 2 : 0;
}

/// Where a segment about the origin is nearest to p.
double nearestTo(const Vec3& p, const Vec3& half)
{
    const double squared = half.squaredNorm();
    return squared > 0.0 ? std::clamp(p.dot(half) / squared, -1.0, 1.0) : 0.0;
}

/// Where two segments are nearest to each other; those that are parallel, somewhere.
Places nearestOf(const Vec3& c, const Vec3& a, const Vec3& b)
{
    const double ab = a.dot(b), bb = b.squaredNorm();
    const double determinant = a.squaredNorm() * bb - ab * ab;
    const double s = determinant > 0.0 ? (ab * b.dot(c) - bb * a.dot(c)) / determinant : 0.0;
    const double t = nearestTo(c + std::clamp(s, -1.0, 1.0) * a, b);
    return {nearestTo(t * b - c, a), t};
}

/// Segments that cross are led apart across both.
Vec3 normalOf(const Vec3& between, const Vec3& a, const Vec3& b, const Vec3& c)
{
    if (between.squaredNorm() > 0.0) return between.normalized();
    const Vec3 across = a.cross(b);
    const Vec3 along = a.isZero(0.0) ? b : a;
    const Vec3 n = across.squaredNorm() > 0.0 ? Vec3(across.normalized())
                   : along.isZero(0.0)        ? Vec3(Vec3::UnitY())
                                              : along.unitOrthogonal();
    return n.dot(c) < 0.0 ? Vec3(-n) : n;
}

double findOnPlane(const Vec3& c, const Vec3& a, double radius, double reach,
                   std::vector<CapsuleContact>& found)
{
    const Vec3 n = Vec3::UnitY();
    double nearest = std::numeric_limits<double>::infinity();
    for (const double s : {-1.0, 1.0}) {
        const Vec3 end = c + s * a;
        const double gap = end.dot(n) - radius;
        nearest = std::min(nearest, gap);
        if (gap < reach)
            found.push_back({a.isZero(0.0) ? 0 : partAt(s), 0, {end - radius * n, n, gap}});
        if (a.isZero(0.0)) break;
    }
    return nearest;
}

}  // namespace

double findCapsuleContacts(const RelativePair& pair, double reach,
                           std::vector<CapsuleContact>& found)
{
    found.clear();
    const Capsule &first = pair.first.capsule, &second = pair.second.capsule;
    const Vec3 &c = pair.translation, &b = second.half;
    const Vec3 a = pair.rotation * first.half;
    if (pair.second.isPlane) return findOnPlane(c, a, first.radius, reach, found);

    const auto contactAt = [&](const Places& at) {
        const Vec3 place = c + at.s * a, between = place - at.t * b;
        const Vec3 n = normalOf(between, a, b, c);
        return CapsuleContact{
            partAt(at.s),
            partAt(at.t),
            {place - first.radius * n, n, between.norm() - first.radius - second.radius}};
    };
    double nearest = std::numeric_limits<double>::infinity();
    const auto tell = [&](const CapsuleContact& one) {
        nearest = std::min(nearest, one.contact.gap);
        if (one.contact.gap < reach) found.push_back(one);
    };
    if (!first.isBall() && !second.isBall()) {
        for (const double s : {-1.0, 1.0}) tell(contactAt({s, nearestTo(c + s * a, b)}));
        for (const double t : {-1.0, 1.0}) {
            const double s = nearestTo(t * b - c, a);
            if (partAt(s) == 0) tell(contactAt({s, t}));  // else that end has spoken
        }
    }
    const CapsuleContact between = contactAt(nearestOf(c, a, b));
    const double nearer = kNearer * std::min(first.radius, second.radius);
    if (between.contact.gap < nearest - nearer) tell(between);
    return nearest;
}

}  // namespace scree
