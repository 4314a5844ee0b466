// Symbols: n direction out of the second body, d unit direction of an edge.
#include "core/collision/convex_overlap.h"

#include <limits>

#include "core/collision/hull_distance.h"

namespace scree {
namespace {

/// Sine of the angle between two edges below which they span no direction of their own.
constexpr double kParallel = 1e-4;

/// An edge is asked for the way out only where it is shorter by this share than that through a
/// face, of which rounding must not decide from step to step.
constexpr double kFaceFirst = 1e-3;

/// The face of the second out of which the first has the shortest way; a gap above zero where it is
/// wholly before one.
FeatureContact outOfFaces(const RelativePair& pair)
{
    FeatureContact best{Vec3::Zero(), Vec3::UnitY(), -std::numeric_limits<double>::infinity()};
    const ContactFeatures& second = pair.second.features;
    for (const std::int32_t e : second.hullEdges()) {
        const ConvexEdge& edge = second.edges()[e];
        for (const Vec3& n : edge.faceNormal) {
            const Vec3 deepest =
                pair * supportOf(pair.first.features, -(pair.rotation.transpose() * n));
            const double gap = n.dot(deepest - edge.start);
            if (gap > best.gap) best = {deepest, n, gap};
        }
    }
    return best;
}

/// As seen from the other body.
FeatureContact seenBack(const RelativePair& pair, const FeatureContact& ofBack)
{
    const Vec3 onSecond = pair * ofBack.point, n = -(pair.rotation * ofBack.normal);
    return {onSecond + ofBack.gap * n, n, ofBack.gap};
}

/// Whether two edges make a face of the Minkowski difference: their arcs between the normals of
/// their faces, one of them turned about, cross on the Gauss sphere.
bool makeAFace(const std::array<Vec3, 2>& ofFirst, const Vec3& dFirst,
               const std::array<Vec3, 2>& ofSecond, const Vec3& dSecond)
{
    const double c = -ofSecond[0].dot(dFirst), d = -ofSecond[1].dot(dFirst);
    const double a = ofFirst[0].dot(dSecond), b = ofFirst[1].dot(dSecond);
    if (c * d >= 0.0 || a * b >= 0.0) return false;
    // On the same half of the sphere, not on opposite ones.
    const Vec3 crossing = dFirst.cross(dSecond);
    const double side = crossing.dot(ofFirst[0] + ofFirst[1]);
    return side * crossing.dot(ofSecond[0] + ofSecond[1]) < 0.0;
}

}  // namespace

std::optional<FeatureContact> overlapOfConvex(const RelativePair& pair)
{
    if (!pair.first.features.isConvex() || !pair.second.features.isConvex()) return {};
    FeatureContact best = outOfFaces(pair);
    if (best.gap >= 0.0) return {};
    const FeatureContact back = seenBack(pair, outOfFaces(pair.reversed()));
    if (back.gap >= 0.0) return {};
    if (back.gap > best.gap) best = back;
    const ContactFeatures &first = pair.first.features, &second = pair.second.features;
    for (const std::int32_t ofFirst : first.hullEdges()) {
        const ConvexEdge& a = first.edges()[ofFirst];
        const Vec3 dA = pair.rotation * a.direction, start = pair * a.start;
        const std::array<Vec3, 2> faces = {pair.rotation * a.faceNormal[0],
                                           pair.rotation * a.faceNormal[1]};
        for (const std::int32_t ofSecond : second.hullEdges()) {
            const ConvexEdge& b = second.edges()[ofSecond];
            if (!makeAFace(faces, dA, b.faceNormal, b.direction)) continue;
            const Vec3 across = dA.cross(b.direction);
            const double sine = across.norm();
            if (sine < kParallel) continue;
            const Vec3 n = across / (across.dot(b.outward) > 0.0 ? sine : -sine);
            const double gap = n.dot(start - b.start);
            if (gap >= 0.0) return {};
            if (gap <= (1.0 - kFaceFirst) * best.gap) continue;
            const double cosine = dA.dot(b.direction);
            const Vec3 between = start - b.start;
            const double s = (cosine * b.direction.dot(between) - dA.dot(between)) / (sine * sine);
            best = {start + s * dA, n, gap};
        }
    }
    return best;
}

}  // namespace scree
