// Symbols: w a point of the first hull less one of the second.
#include "core/collision/hull_distance.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

constexpr std::size_t kFewCorners = 64;

/// Steps after which the best bound so far must do.
constexpr int kMostSteps = 10;

/// A bound of this share of the distance will do.
constexpr double kCloseEnough = 0.9;

/// Up to three points whose hull holds the point nearest to the origin.
struct Simplex {
    std::array<Vec3, 3> points;
    int count = 0;
    Vec3 nearest = Vec3::Zero();
};

/// The nearest of a triangle to the origin, without the corners that do not matter for it.
Simplex nearestOf(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const ClosestOnTriangle found = closestOnTriangle(Vec3::Zero(), {a, b, c});
    switch (found.feature) {
        case TriangleFeature::a:
            return {{a}, 1, found.point};
        case TriangleFeature::b:
            return {{b}, 1, found.point};
        case TriangleFeature::c:
            return {{c}, 1, found.point};
        case TriangleFeature::ab:
            return {{a, b}, 2, found.point};
        case TriangleFeature::bc:
            return {{b, c}, 2, found.point};
        case TriangleFeature::ca:
            return {{c, a}, 2, found.point};
        case TriangleFeature::face:
            break;
    }
    return {{a, b, c}, 3, found.point};
}

/// Of what a simplex and one point more span; that point is a corner of what is nearest.
Simplex withPoint(const Simplex& simplex, const Vec3& w)
{
    const auto& p = simplex.points;
    if (simplex.count == 0) return {{w}, 1, w};
    if (simplex.count == 1) return nearestOf(w, p[0], p[0]);
    Simplex best = nearestOf(w, p[0], p[1]);
    if (simplex.count == 2) return best;
    for (const Simplex& other : {nearestOf(w, p[1], p[2]), nearestOf(w, p[2], p[0])}) {
        if (other.nearest.squaredNorm() < best.nearest.squaredNorm()) best = other;
    }
    return best;
}

}  // namespace

Vec3 supportOf(const ContactFeatures& features, const Vec3& direction)
{
    double best = -std::numeric_limits<double>::infinity();
    std::int32_t at = 0;
    for (const std::int32_t corner : features.corners()) {
        const double along = features.points().col(corner).dot(direction);
        if (along > best) {
            best = along;
            at = corner;
        }
    }
    return features.points().col(at);
}

bool areHullsSmall(const RelativePair& pair)
{
    const auto isSmall = [](const Shape& shape) {
        const std::size_t corners = shape.features.corners().size();
        return corners > 0 && corners <= kFewCorners;
    };
    return isSmall(pair.first) && isSmall(pair.second);
}

double hullsApart(const RelativePair& pair)
{
    const ContactFeatures &first = pair.first.features, &second = pair.second.features;
    double atLeast = -std::numeric_limits<double>::infinity();
    Simplex simplex;
    Vec3 direction = Vec3::UnitX();
    if (!pair.translation.isZero(0.0)) direction = pair.translation.normalized();
    for (int step = 0; step < kMostSteps; ++step) {
        const Vec3 onFirst = pair * supportOf(first, pair.rotation.transpose() * -direction);
        const Vec3 w = onFirst - supportOf(second, direction);
        atLeast = std::max(atLeast, direction.dot(w));
        simplex = withPoint(simplex, w);
        const double distance = simplex.nearest.norm();
        if (!(distance > 0.0) || atLeast >= kCloseEnough * distance) break;
        direction = simplex.nearest / distance;
    }
    return atLeast;
}

}  // namespace scree
