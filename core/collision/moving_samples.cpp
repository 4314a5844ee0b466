// Symbols: phi signed distance to the other body, a unit axis of a cylinder.
#include "core/collision/moving_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace scree {
namespace {

// Ids: of each rim its deepest point, then eight fixed ones; last the side.
constexpr std::int32_t kFixedOnRim = 8;
constexpr std::int32_t kRimSamples = 1 + kFixedOnRim;
constexpr std::int32_t kSideSample = 2 * kRimSamples;
constexpr double kCosEighth = 0.70710678118654752440;  // of a turn; its sine is the same

/// A sample that would move farther than this share of the radius within a step does not roll: a
/// cap that lies flat has no deepest point, and in a groove the nearest wall may be the other one.
constexpr double kFarthestRoll = 0.5;

constexpr double kStanding = 0.86602540378443864676;  // cosine of the tilt

constexpr int kRimScan = 16;      // points of the first look around a rim
constexpr int kRimHalvings = 12;  // of the angle between them: 0.005° at the end
constexpr double kCosSixteenth = 0.92387953251128675613;  // of a turn
constexpr double kSinSixteenth = 0.38268343236508977173;

constexpr int kAxisScan = 16;  // intervals of the first look along an axis
constexpr int kAxisThirds = 24;

struct Nearest {
    double phi;
    Vec3 outward;  // unit, away from the closest point of the surface or from inside towards it
};

/// Distance and direction of the closest point of the surface. Far from a mesh the lattice knows
/// the direction only roughly; its triangles know it well.
Nearest nearestSurface(const Shape& field, const Vec3& point)
{
    const SignedDistance::Sloped sloped = field.distance.sloped(point);
    const bool isExact =
        field.distance.solid() || std::abs(sloped.value) < field.distance.refinementBand();
    if (isExact || field.distance.refinementBand() == 0.0) {
        return {sloped.value, sloped.gradient.normalized()};
    }
    const int triangle = field.rays.closestTriangle(point);
    const Vec3 away = point - closestOnTriangle(point, cornersOf(field.mesh, triangle)).point;
    const double phi = std::copysign(away.norm(), sloped.value);
    return {phi, away / phi};
}

/// The deepest point of a ball, in the field's frame. Of a ball that has gone through a thin wall
/// it is the middle of the wall: its far side would say that nothing is overlapped.
Vec3 deepestOfBall(const Shape& field, const Vec3& centre, double radius)
{
    const Nearest nearest = nearestSurface(field, centre);
    const double depth = std::min(radius - nearest.phi, 0.5 * field.thickness());
    return centre - (nearest.phi + depth) * nearest.outward;
}

/// A rim of a cylinder seen from the field; points are told by a direction (cosine, sine).
struct Rim {
    Vec3 centre, x, z;  // x and z as long as the radius

    Vec3 at(const Eigen::Vector2d& direction) const
    {
        return centre + direction.x() * x + direction.y() * z;
    }
};

Rim placeRim(const Shape& sampled, const FieldFromSamples& pose, bool isTop)
{
    const Vec3& half = sampled.distance.solid()->half();
    const Vec3 centre(0.0, isTop ? half.y() : -half.y(), 0.0);
    return {pose * centre, half.x() * pose.rotation.col(0), half.x() * pose.rotation.col(2)};
}

Eigen::Vector2d turned(const Eigen::Vector2d& direction, double cosine, double sine)
{
    return {cosine * direction.x() - sine * direction.y(),
            sine * direction.x() + cosine * direction.y()};
}

/// Direction of the rim's deepest point. Against a plane that is where the plane's normal points
/// away from; elsewhere the rim is looked at all around first.
Eigen::Vector2d deepestOfRim(const Shape& field, const Rim& rim)
{
    const Vec3 outward = nearestSurface(field, rim.centre).outward;
    Eigen::Vector2d best(-outward.dot(rim.x), -outward.dot(rim.z));
    // A cap that lies flat has no deepest point: any direction will do, if it is always the same.
    const bool isFlat = best.norm() < 1e-9 * rim.x.norm();
    best = isFlat ? Eigen::Vector2d(1.0, 0.0) : Eigen::Vector2d(best.normalized());
    if (field.isPlane) return best;

    double bestPhi = field.distance.value(rim.at(best));
    const auto tryOut = [&](const Eigen::Vector2d& direction) {
        const double phi = field.distance.value(rim.at(direction));
        if (phi >= bestPhi) return false;
        bestPhi = phi;
        best = direction;
        return true;
    };
    Eigen::Vector2d around = best;
    for (int i = 1; i < kRimScan; ++i) {
        around = turned(around, kCosSixteenth, kSinSixteenth);
        tryOut(around);
    }
    double cosine = kCosSixteenth, sine = kSinSixteenth;
    for (int i = 0; i < kRimHalvings; ++i) {
        const double half = std::sqrt(0.5 * (1.0 + cosine));
        sine *= 0.5 / half;
        cosine = half;
        if (!tryOut(turned(best, cosine, sine))) tryOut(turned(best, cosine, -sine));
    }
    return best.normalized();
}

/// Whether the cap faces the other body, within 30°. A rim that rolls needs no fixed points, and
/// would be braked by them.
bool standsOn(const Shape& field, const Rim& rim)
{
    const Vec3 cap = rim.x.cross(rim.z) / rim.x.squaredNorm();
    return std::abs(cap.dot(nearestSurface(field, rim.centre).outward)) > kStanding;
}

/// The deepest point of the side between the rims, in the field's frame; where the axis comes
/// closest to the other body. An end of the axis is left to its rim, and answers with it.
Vec3 deepestOfSide(const Shape& sampled, const Shape& field, const FieldFromSamples& pose)
{
    const Vec3& half = sampled.distance.solid()->half();
    const Vec3 axis = pose.rotation.col(1);
    const auto on = [&](double t) -> Vec3 { return pose.translation + t * half.y() * axis; };
    const auto phiAt = [&](double t) { return field.distance.value(on(t)); };
    double best = -1.0, bestPhi = phiAt(best);
    for (int i = 1; i <= kAxisScan; ++i) {
        const double t = 2.0 * i / kAxisScan - 1.0;
        const double phi = phiAt(t);
        if (phi >= bestPhi) continue;
        best = t;
        bestPhi = phi;
    }
    double low = std::max(-1.0, best - 2.0 / kAxisScan);
    double high = std::min(1.0, best + 2.0 / kAxisScan);
    for (int i = 0; i < kAxisThirds; ++i) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        (phiAt(a) < phiAt(b) ? high : low) = phiAt(a) < phiAt(b) ? b : a;
    }
    return deepestOfBall(field, on(0.5 * (low + high)), half.x());
}

/// The vertex of a touch, or of its edge the nearer end.
std::int32_t nearestVertex(const SurfaceSamples& samples, const Touch& touch)
{
    const auto vertexCount = static_cast<std::int32_t>(samples.vertices.cols());
    if (touch.sample < vertexCount) return touch.sample;
    const auto [a, b] = samples.edges[(touch.sample - vertexCount) / 3];
    const double toA = (touch.point - samples.vertices.col(a)).squaredNorm();
    const double toB = (touch.point - samples.vertices.col(b)).squaredNorm();
    return toA <= toB ? a : b;
}

bool isSphere(const Shape& shape)
{
    return shape.distance.solid()->form() == ExactSolid::Form::sphere;
}

}  // namespace

void findMovingTouches(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                       double tau, bool sampleOnA, std::vector<Touch>& touches)
{
    if (field.distance.isClearOf(pose.translation, sampled.boundingRadius + tau)) return;
    const auto touch = [&](std::int32_t sample, const Vec3& inField) {
        const double phi = field.distance.value(inField);
        if (phi < tau) touches.push_back({phi, sample, sampleOnA, pose.back(inField)});
    };
    const double radius = sampled.distance.solid()->half().x();
    if (isSphere(sampled)) {
        touch(0, deepestOfBall(field, pose.translation, radius));
        return;
    }
    for (std::int32_t top = 0; top < 2; ++top) {
        const Rim rim = placeRim(sampled, pose, top == 1);
        if (field.distance.isClearOf(rim.centre, radius + tau)) continue;
        touch(top * kRimSamples, rim.at(deepestOfRim(field, rim)));
        if (!standsOn(field, rim)) continue;
        Eigen::Vector2d fixed(1.0, 0.0);
        for (std::int32_t k = 1; k <= kFixedOnRim; ++k) {
            touch(top * kRimSamples + k, rim.at(fixed));
            fixed = turned(fixed, kCosEighth, kCosEighth);
        }
    }
    // Along a side the distance to a plane is linear: the rims say all.
    if (!field.isPlane) {
        const Vec3 side = deepestOfSide(sampled, field, pose);
        const double along = std::abs(pose.back(side).y());
        if (along < sampled.distance.solid()->half().y()) touch(kSideSample, side);
    }
}

Vec3 movingSample(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                  const Touch& touch)
{
    const double radius = sampled.distance.solid()->half().x();
    Vec3 moved = touch.point;
    if (isSphere(sampled)) {
        moved = pose.back(deepestOfBall(field, pose.translation, radius));
    } else if (touch.sample == kSideSample) {
        moved = pose.back(deepestOfSide(sampled, field, pose));
    } else if (touch.sample % kRimSamples == 0) {
        const Rim rim = placeRim(sampled, pose, touch.sample == kRimSamples);
        moved = pose.back(rim.at(deepestOfRim(field, rim)));
    }
    return (moved - touch.point).norm() <= kFarthestRoll * radius ? moved : touch.point;
}

Vec3 slidSample(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                const Touch& touch, const Vec3& normal)
{
    if (sampled.smooth.isEmpty()) return touch.point;
    const std::int32_t vertex = nearestVertex(sampled.samples, touch);
    const Vec3 own = sampled.smooth.normalAt(vertex);
    const auto facing = [&](const Vec3& direction) {
        return sampled.smooth.placeFacing(vertex, direction);
    };
    Vec3 direction = -(pose.rotation.transpose() * normal);
    std::optional<Vec3> place = facing(direction);
    if (!place) return touch.point;
    if (!field.isPlane && !field.usesTrueNormals) {
        // The other body's normal turns on the way. One secant step finds where the two normals are
        // opposite; it is exact for spheres. Bodies that fit into each other have no such place.
        const Vec3 there = field.distance.gridGradient(pose * *place).normalized();
        const Vec3 next = -(pose.rotation.transpose() * there);
        const Vec3 change = direction - own;
        const double ratio = change.squaredNorm() > 0.0
                                 ? (next - direction).dot(change) / change.squaredNorm()
                                 : 0.0;
        if (ratio > 0.5) return touch.point;
        direction = (own + change / (1.0 - ratio)).normalized();
        place = facing(direction);
        if (!place) return touch.point;
    }
    // Of a saddle the place may be the highest between two contacts instead of the lowest.
    const Vec3 way = *place - touch.point;
    const Vec3 along = way - way.dot(own) * own;
    return along.dot(pose.rotation.transpose() * normal) > 0.0 ? touch.point : *place;
}

}  // namespace scree
