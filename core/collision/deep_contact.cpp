// Symbols: c centre of the ball in the frame of the second shape, r its radius, phi the second's
// signed distance.
#include "core/collision/deep_contact.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

/// From this share of its radius on a ball speaks: above it features may fail.
constexpr double kDeep = 0.25;

/// Below it a field has no slope to speak of: the point is as far from both sides.  [A5]
constexpr double kShortSlope = 0.1;

Vec3 unitOr(const Vec3& direction, double least, const Vec3& otherwise)
{
    const double length = direction.norm();
    return length > least ? Vec3(direction / length) : otherwise;
}

/// The way from the middle of the second to the ball of the first, if the field tells none.
Vec3 wayOut(const RelativePair& pair, const Vec3& c, const Vec3& slope)
{
    const double hardly = 1e-6 * pair.second.boundingRadius;
    const Vec3 fromMiddle = unitOr(c - pair.second.innerBall.centre, hardly, Vec3::UnitY());
    return unitOr(slope, kShortSlope, fromMiddle);
}

/// With a gap that is not negative where the ball is not deep.
FeatureContact ballOfFirst(const RelativePair& pair)
{
    const Ball& ball = pair.first.innerBall;
    const Vec3 c = pair * ball.centre;
    const double r = ball.radius;
    const double within = pair.second.boundingRadius + r;
    if (c.squaredNorm() > within * within) return {};
    if (pair.second.distance.gridValue(c) - r > -kDeep * r) return {};
    const SignedDistance::Sloped phi = pair.second.distance.sloped(c);
    const Vec3 normal = wayOut(pair, c, phi.gradient);
    return {c - r * normal, normal, phi.value - r};
}

/// Until the ball of the first is deep, by whichever value of the field says so first; or `far`
/// [m].
double wayOfFirst(const RelativePair& pair, double far)
{
    const Vec3 c = pair * pair.first.innerBall.centre;
    const double most = (1.0 - kDeep) * pair.first.innerBall.radius;
    if (c.norm() - pair.second.boundingRadius - most >= far) return far;
    const double grid = pair.second.distance.gridValue(c);
    const double low = pair.second.distance.lowerBound(c, grid);
    return low - std::abs(grid - low) - most;
}

}  // namespace

std::optional<DeepContact> findDeepContact(const RelativePair& pair, const RelativePair& back)
{
    if (pair.first.isPlane || pair.second.isPlane) return std::nullopt;
    const FeatureContact ofFirst = ballOfFirst(pair), ofSecond = ballOfFirst(back);
    const bool isOfFirst = ofFirst.gap <= ofSecond.gap;
    const FeatureContact& deeper = isOfFirst ? ofFirst : ofSecond;
    const double radius = (isOfFirst ? pair.first : pair.second).innerBall.radius;
    if (deeper.gap >= -kDeep * radius || radius == 0.0) return std::nullopt;
    return DeepContact{deeper, isOfFirst, deeper.gap <= -radius};
}

double wayToDeepContact(const RelativePair& pair, const RelativePair& back, double far)
{
    if (pair.first.isPlane || pair.second.isPlane) return far;
    return std::min({far, wayOfFirst(pair, far), wayOfFirst(back, far)});
}

}  // namespace scree
