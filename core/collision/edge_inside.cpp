#include "core/collision/edge_inside.h"

#include <algorithm>
#include <limits>

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastWay = 0.01;   // along an edge, of its length
constexpr double kFinestWay = 1e-3;  // where that is too coarse to meet what is as near as asked

/// An edge of the first in the frame of the second.
struct PlacedEdge {
    const Shape& second;
    Vec3 start, direction;
    double length;

    PlacedEdge(const RelativePair& pair, const ConvexEdge& edge)
        : second(pair.second),
          start(pair * edge.start),
          direction(pair.rotation * edge.direction),
          length(edge.length)
    {
    }
    Vec3 at(double along) const { return start + along * direction; }
    double distanceAt(double along) const { return second.distance.value(at(along)); }
};

/// A part of an edge, by the way from its start [m].
struct Part {
    double from, to;

    double middle() const { return 0.5 * (from + to); }
};

/// Whether a part of an edge that lies inside is seen to lie no deeper than that [m]. The distance
/// to a face is convex: none between two places of a line is farther away from it than both.
bool isShallow(const PlacedEdge& edge, const Part& part, double depth)
{
    constexpr int kHalvings = 6;
    const SignedDistance& field = edge.second.distance;
    const double leastStep = 1e-3 * (part.to - part.from);
    for (double along = part.from; along < part.to;) {
        const Vec3 place = edge.at(along);
        if (!field.isRefined(field.gridValue(place))) return false;
        const SignedDistance::Nearest nearest = field.nearest(place);
        if (nearest.value < -depth) return false;
        const auto isNearFace = [&](double to) {
            return field.distanceToFace(nearest.face, edge.at(to)) <= depth;
        };
        if (isNearFace(part.to)) return true;
        // No distance changes faster than the way.
        double near = along + depth + nearest.value, far = part.to;
        for (int i = 0; i < kHalvings && near < far; ++i) {
            const double middle = 0.5 * (near + far);
            (isNearFace(middle) ? near : far) = middle;
        }
        if (near < along + leastStep) return false;
        along = near;
    }
    return true;
}

/// Places along a part of an edge, told to look(along, distance from the second), which answers
/// below what distance others matter: those that can be nearer are told of, but for what is
/// shorter than `least` [m].
template <class Look>
void lookAlong(const PlacedEdge& edge, const Part& part, double least, const Look& look)
{
    const SignedDistance& field = edge.second.distance;
    for (double along = part.from; along <= part.to;) {
        const Vec3 place = edge.at(along);
        const double value = field.value(place), below = look(along, value);
        // Of values far away nobody knows whether they are above the true distance.
        const double apart = value < field.refinementBand() ? value : field.lowerBound(place);
        along += std::max(apart - below, least);
    }
}

/// Tells `visit` the parts of an edge that lie in the second and may be deeper there than `depth`
/// [m]; where a formula is the surface, all of the edge.
template <class Visit>
void visitDeepParts(const PlacedEdge& edge, double depth, const Visit& visit)
{
    if (edge.second.distance.solid()) return visit(Part{0.0, edge.length});
    // Nothing shorter than the depth is as deep, so that just behind a face some may go unseen.
    for (double from = 0.0, seen = 0.0; seen < edge.length;) {
        const auto hit = edge.second.rays.firstHit(edge.at(seen), edge.direction,
                                                   edge.length - seen, SurfaceRays::Facing::any);
        const double to = hit ? std::clamp(seen + hit->distance, seen, edge.length) : edge.length;
        const Part part{from, to};
        if (to - from > depth && edge.distanceAt(part.middle()) < 0.0 &&
            !isShallow(edge, part, depth)) {
            visit(part);
        }
        from = to;
        seen = to + depth;
    }
}

}  // namespace

bool comesWithin(const RelativePair& pair, const ConvexEdge& edge, double reach)
{
    // An edge that lies flush on a face is about as near as nothing all along: asked whether it
    // comes nearer, with no least way, one chair on another took half a second.
    const double least = std::clamp(reach, kFinestWay * edge.length, kLeastWay * edge.length);
    bool isNear = false;
    lookAlong({pair, edge}, {0.0, edge.length}, least, [&](double, double apart) {
        isNear = isNear || apart < reach;
        return isNear ? -kInfinity : reach;  // nothing else matters
    });
    return isNear;
}

double deepestAlong(const RelativePair& pair, const ConvexEdge& edge, double enough)
{
    constexpr int kHalvings = 10;
    const PlacedEdge placed(pair, edge);
    double least = kInfinity;
    visitDeepParts(placed, -enough, [&](const Part& part) {
        double at = part.middle();
        const auto offer = [&](double along, double value) {
            if (value < least) {
                least = value;
                at = along;
            }
            return std::min(least, enough);
        };
        double step = kLeastWay * edge.length;
        lookAlong(placed, part, step, offer);
        // The last halving ends within two steps of here.
        for (int i = 0; i < kHalvings && least - 2.0 * step < enough; ++i, step *= 0.5) {
            const double middle = at;
            for (const double along : {middle - step, middle + step}) {
                const double place = std::clamp(along, part.from, part.to);
                offer(place, placed.distanceAt(place));
            }
        }
    });
    return least;
}

}  // namespace scree
