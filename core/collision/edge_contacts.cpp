// Symbols: n normal where two edges cross, out of the second, d unit direction of an edge, s and t
//          places along two edges.
#include "core/collision/edge_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/collision/edge_inside.h"

namespace scree {
namespace {

constexpr double kRounding = 1e-9;  // of lengths

/// Sine of the angle by which a face may lean out from the way on which an edge leaves, and still
/// be taken for one along it. Of boxes flush with each other faces lean by rounding, to either
/// side.
constexpr double kNearlySquare = 5e-3;

/// Where the lines of two edges are closest.
struct Crossing {
    Vec3 onFirst, onSecond, normal;    // normal not oriented
    double alongFirst, alongSecond;    // from the starts of the edges
    double beyondFirst, beyondSecond;  // how far past the ends of either edge, ≤ 0 within [m]
    int endOfFirst, endOfSecond;       // which end that is
};

std::optional<Crossing> crossing(const Vec3& startA, const Vec3& dA, double lengthA,
                                 const Vec3& startB, const Vec3& dB, double lengthB)
{
    const double cosine = dA.dot(dB);
    const double sineSquared = 1.0 - cosine * cosine;
    if (sineSquared < kParallel * kParallel) return {};
    const Vec3 between = startA - startB;
    const double alongA = dA.dot(between), alongB = dB.dot(between);
    const double s = (cosine * alongB - alongA) / sineSquared;
    const double t = (alongB - cosine * alongA) / sineSquared;
    return Crossing{startA + s * dA,
                    startB + t * dB,
                    dA.cross(dB).normalized(),
                    s,
                    t,
                    std::max(-s, s - lengthA),
                    std::max(-t, t - lengthB),
                    s < 0.0 ? 0 : 1,
                    t < 0.0 ? 0 : 1};
}

/// Whether the shape comes within `reach` of a place [m].
bool isNear(const Shape& shape, const Vec3& place, double reach)
{
    return shape.distance.value(place) < reach;
}

/// Whether the lines of two edges that overlap are nearest where these are, or not far past an end
/// of them. Of an edge that goes on straight the next piece speaks there, and on a fine surface
/// those around its end do: of pebbles in a heap four in five pairs of edges that were asked were
/// such. The edges themselves must be where edges that touch are looked for: near the other body,
/// and not outside each other.
bool overlapNearEnds(const RelativePair& pair, const ConvexEdge& a, const ConvexEdge& b,
                     const Crossing& at, double gap, double reach)
{
    const auto isSpokenFor = [](const ConvexEdge& edge, double past, int end) {
        return past > 0.0 && (edge.goesOn[end] || edge.endsFine[end]);
    };
    if (isSpokenFor(a, at.beyondFirst, at.endOfFirst)) return false;
    if (isSpokenFor(b, at.beyondSecond, at.endOfSecond)) return false;
    const double beyond = std::max(at.beyondFirst, 0.0) + std::max(at.beyondSecond, 0.0);
    const double deepest = deepestEdges(pair);
    if (beyond > -kPastEnds * gap || beyond * beyond + gap * gap > deepest * deepest) return false;
    const Vec3 start = pair * a.start, direction = pair.rotation * a.direction;
    const Vec3 nearFirst = start + std::clamp(at.alongFirst, 0.0, a.length) * direction;
    const double along = std::clamp(b.direction.dot(nearFirst - b.start), 0.0, b.length);
    const Vec3 onSecond = b.start + along * b.direction;
    const double alongFirst = std::clamp(direction.dot(onSecond - start), 0.0, a.length);
    const Vec3 onFirst = start + alongFirst * direction;
    return (onFirst - onSecond).dot(b.outward) <= 0.0 && isNear(pair.second, onFirst, reach) &&
           isNear(pair.first, pair.reversed() * onSecond, reach);
}

/// In the notch where two edges of a hollow outline meet, an edge that lies a hair too deep is
/// nearest to both of them past their ends, inside the body: it touches all the same.
bool crossesInNotch(const RelativePair& pair, const Crossing& at)
{
    // There an edge goes on in the face beside it, neither inside nor outside.
    const auto isHollow = [](const Shape& shape, const Vec3& place, double past) {
        return past <= 0.0 || shape.distance.value(place) <= kNearlySquare * past;
    };
    return isHollow(pair.first, pair.reversed() * at.onFirst, at.beyondFirst) &&
           isHollow(pair.second, at.onSecond, at.beyondSecond);
}

/// How far from where it crosses an edge, `-gap` inside along n, a line is deepest under the nearer
/// of the faces beside that edge: where it goes down under one face no faster than it comes up from
/// the other.
double placeOfDip(const ConvexEdge& edge, const Vec3& n, double gap, const Vec3& direction)
{
    const Vec3 &face0 = edge.faceNormal[0], &face1 = edge.faceNormal[1];
    const double slope0 = direction.dot(face0), slope1 = direction.dot(face1);
    if (slope0 * slope1 >= 0.0) return 0.0;
    return gap * n.dot(face1 - face0) / (slope0 - slope1);
}

/// Where an edge that crosses another is taken to be deepest: how far from the crossing, and its
/// height above the nearer of the faces beside the other.
struct Dip {
    double along, height;  // [m]
};

/// For what touches that is at the crossing. Beside an edge sharper than square it is not: there
/// the line that crosses is still outside, and enters some way off. The line begins `before` the
/// crossing and ends `after`.
Dip deepestBeside(const ConvexEdge& edge, const Vec3& n, double gap, const Vec3& direction,
                  double before, double after)
{
    const Vec3 &face0 = edge.faceNormal[0], &face1 = edge.faceNormal[1];
    const double height0 = gap * n.dot(face0), height1 = gap * n.dot(face1);
    const double slope0 = direction.dot(face0), slope1 = direction.dot(face1);
    if (std::max(height0, height1) <= 0.0 || slope0 * slope1 >= 0.0)
        return {0.0, std::min(0.0, std::max(height0, height1))};
    const double along = std::clamp(placeOfDip(edge, n, gap, direction), -std::max(before, 0.0),
                                    std::max(after, 0.0));
    return {along, std::min(0.0, std::max(height0 + along * slope0, height1 + along * slope1))};
}

/// How the edge of the first, which crosses one of the second `-gap` inside along n, lies there.
struct Sunk {
    bool isAsDeep;  // in the second as under the nearer of the faces beside that edge, about
    bool isNear;    // to the second, by `reach`
};

Sunk sunkBeside(const RelativePair& pair, const ConvexEdge& ofFirst, const ConvexEdge& ofSecond,
                const Vec3& onFirst, const Vec3& n, double gap, double along, double reach)
{
    const Vec3 direction = pair.rotation * ofFirst.direction;
    const Dip dip = deepestBeside(ofSecond, n, gap, direction, along, ofFirst.length - along);
    const double rounding = kRounding * (ofFirst.length + ofSecond.length);
    const double onEdge = std::clamp(dip.along, -along, ofFirst.length - along);
    const double value = pair.second.distance.value(onFirst + onEdge * direction);
    return {value <= 0.5 * dip.height + rounding, value < reach};
}

/// Whether the edge of the first, which crosses one of the second at `onFirst`, comes in under a
/// face by half of `depth`: not beside the second, where everything is under the plane of that
/// face. Of an edge that goes on straight the next piece counts too.
bool comesInUnder(const RelativePair& pair, const ConvexEdge& ofFirst, const ConvexEdge& ofSecond,
                  const Vec3& onFirst, const Vec3& face, double depth)
{
    const Vec3 direction = pair.rotation * ofFirst.direction;
    const double sinks = -direction.dot(face);
    const double way = (0.5 * depth - face.dot(ofSecond.start - onFirst)) / sinks;
    const double place = direction.dot(onFirst - pair * ofFirst.start) + way;
    const double begin = ofFirst.goesOn[0] ? -ofFirst.length : 0.0;
    const double end = ofFirst.goesOn[1] ? 2.0 * ofFirst.length : ofFirst.length;
    if (!(place >= begin && place <= end)) return false;
    return pair.second.distance.value(onFirst + way * direction) <= kNearlySquare * depth;
}

/// Of boxes flush with each other a face beside the edge of the second leans out from the way by
/// rounding, and where the edge of the first is deepest another face is as near. Whether it has
/// come in under that face all the same.
bool comesInFlush(const RelativePair& pair, const ConvexEdge& ofFirst, const ConvexEdge& ofSecond,
                  const Vec3& onFirst, const Vec3& n, double depth)
{
    const std::array<Vec3, 2>& faces = ofSecond.faceNormal;
    const Vec3& leaning = n.dot(faces[0]) < n.dot(faces[1]) ? faces[0] : faces[1];
    return std::abs(n.dot(leaning)) <= kNearlySquare &&
           comesInUnder(pair, ofFirst, ofSecond, onFirst, leaning, depth);
}

/// Whether an edge of the second goes on inside the first, deeper than `depth` under one of its own
/// faces: then the first covers more than what pokes through that face.
bool isCoveredUnder(const RelativePair& pair, const Vec3& onFace, const Vec3& face, double depth)
{
    constexpr double kLeastStep = 0.1;  // of the depth
    constexpr int kMostSteps = 200;
    const RelativePair back = pair.reversed();
    for (const ConvexEdge& edge : pair.second.features.edges()) {
        const double sinks = -edge.direction.dot(face);
        double from = 0.0, to = edge.length;  // of the edge, where it is deep enough
        if (sinks != 0.0) {
            const double at = (depth - face.dot(onFace - edge.start)) / sinks;
            (sinks > 0.0 ? from : to) = std::clamp(at, 0.0, edge.length);
        } else if (face.dot(onFace - edge.start) < depth) {
            continue;
        }
        // As far as the first is away it cannot be met.
        for (int step = 0; step < kMostSteps && from < to; ++step) {
            const double apart =
                pair.first.distance.value(back * Vec3(edge.start + from * edge.direction));
            if (apart < 0.0) return true;
            from += std::max(apart, kLeastStep * depth);
        }
    }
    return false;
}

/// Whether what lies `depth` inside the second shape along n, the way out where two edges cross at
/// `onFirst`, has a much shorter way out through a face beside the edge of the second: neither the
/// edge of the first nor any corner in the second is nearly as deep under it, nor is any edge of
/// the second that the first covers. A cube that stands on another is deep below its rim only
/// because it stands far from it; it leaves by what it stands on. But the rim of a tilted cube that
/// cuts the corner off another is near to both faces there, and leaves by neither.
bool leavesByFace(const RelativePair& pair, const ConvexEdge& ofFirst, const ConvexEdge& ofSecond,
                  const Vec3& onFirst, const Vec3& n, double depth)
{
    const std::vector<std::int32_t>& corners = pair.first.features.corners();
    for (const Vec3& face : ofSecond.faceNormal) {
        if (n.dot(face) > 0.5) continue;
        if (comesInUnder(pair, ofFirst, ofSecond, onFirst, face, depth)) continue;
        if (std::none_of(corners.begin(), corners.end(),
                         [&](std::int32_t corner) {
                             const Vec3 p = pair * pair.first.features.points().col(corner);
                             return face.dot(ofSecond.start - p) >= 0.5 * depth &&
                                    pair.second.distance.value(p) < 0.0;
                         }) &&
            !isCoveredUnder(pair, ofSecond.start, face, 0.5 * depth)) {
            return true;
        }
    }
    return false;
}

}  // namespace

FacedEdges faceEdges(const RelativePair& pair, std::int32_t ofFirst, std::int32_t ofSecond,
                     double reach, double sharpness)
{
    const ConvexEdge& a = pair.first.features.edges()[ofFirst];
    const ConvexEdge& b = pair.second.features.edges()[ofSecond];
    const std::optional<Crossing> at = crossing(pair * a.start, pair.rotation * a.direction,
                                                a.length, b.start, b.direction, b.length);
    if (!at) return {};
    const Vec3 n = at->normal.dot(b.outward) >= 0.0 ? at->normal : Vec3(-at->normal);
    const double gap = n.dot(at->onFirst - at->onSecond);
    if (gap >= reach) return {};
    const double rounding = kRounding * (a.length + b.length);
    const bool isWithin = at->beyondFirst <= rounding && at->beyondSecond <= rounding;
    if (!isWithin && !overlapNearEnds(pair, a, b, *at, gap, reach)) return {};
    const bool isPast = !isWithin && !crossesInNotch(pair, *at);
    if (isPast && gap >= -sharpness) return {};
    const Vec3 nOfFirst = pair.rotation.transpose() * n;
    // Of a flat edge, directions from behind it would pass for such that it supports too.
    if (nOfFirst.dot(a.outward) > kSupportSlack) return {};
    if (!edgeSupports(b, -n) || !edgeSupports(a, nOfFirst)) return {};
    if (gap >= -sharpness) return {FeatureContact{at->onFirst, n, gap}, {}};

    // Two edges of solids that overlap elsewhere may pass each other anywhere inside. If these are
    // what overlaps, the first edge is about as deep as the nearer of the faces beside the second,
    // and neither leaves much sooner by a face.
    if (gap < -deepestEdges(pair)) return {};
    const RelativePair back = pair.reversed();
    const Vec3 onSecond = back * at->onSecond, nBack = back.rotation * -n;
    const Sunk first = sunkBeside(pair, a, b, at->onFirst, n, gap, at->alongFirst, reach);
    const Sunk second = sunkBeside(back, b, a, onSecond, nBack, gap, at->alongSecond, reach);
    const bool areSunk = (first.isAsDeep && second.isNear) || (second.isAsDeep && first.isNear) ||
                         comesInFlush(pair, a, b, at->onFirst, n, -gap);
    const bool areWhatOverlaps = areSunk && !leavesByFace(pair, a, b, at->onFirst, n, -gap) &&
                                 !leavesByFace(back, b, a, onSecond, nBack, -gap);
    if (areWhatOverlaps && !isPast) return {FeatureContact{at->onFirst, n, gap}, {}};
    return {{}, FeatureContact{at->onFirst, n, gap}};
}

std::optional<FeatureContact> touchInPassing(const RelativePair& pair, std::int32_t ofFirst,
                                             std::int32_t ofSecond, const FeatureContact& passing,
                                             double reach, double below)
{
    // Only as deep as it lies there, which is no more than how deep their lines are.
    if (passing.gap >= below) return {};
    const ConvexEdge& a = pair.first.features.edges()[ofFirst];
    const ConvexEdge& b = pair.second.features.edges()[ofSecond];
    const RelativePair back = pair.reversed();
    const double ofA = deepestAlong(pair, a, below);
    const double ofB = deepestAlong(back, b, below);
    const double deepest = std::min(ofA, ofB);
    if (deepest >= below) return {};
    // What of them is inside is inside all the same; the other must be where edges that touch are
    // looked for.
    const double within = reach + reachOfBlades(pair);
    if (!(ofA < ofB ? comesWithin(back, b, within) : comesWithin(pair, a, within))) return {};
    return FeatureContact{passing.point, passing.normal, std::max(passing.gap, deepest)};
}

}  // namespace scree
