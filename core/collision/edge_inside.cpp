#include "core/collision/edge_inside.h"

#include <algorithm>
#include <array>
#include <limits>

namespace scree {
namespace {

constexpr double kRounding = 1e-9;  // of lengths
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastWay = 0.01;  // along an edge, of its length

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

/// A part of an edge, by the way from its start [m], and the faces that it ends at, if any.
struct Part {
    double from, to;
    std::array<int, 2> faces = {-1, -1};
};

/// Whether no place of a part lies deeper than that: the distance to a face is convex, and so no
/// greater anywhere than at the end that is not on it.
bool isShallow(const PlacedEdge& edge, const Part& part, double depth)
{
    const auto distance = [&](double along, int face) {
        const auto corner = [&](int k) -> Vec3 {
            return edge.second.mesh.points.col(edge.second.mesh.triangles(k, face));
        };
        const Vec3 place = edge.at(along);
        return (place - closestOnTriangle(place, corner(0), corner(1), corner(2)).point).norm();
    };
    return (part.faces[0] >= 0 && distance(part.to, part.faces[0]) <= depth) ||
           (part.faces[1] >= 0 && distance(part.from, part.faces[1]) <= depth);
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

/// Tells `visit` the parts of an edge that lie in the second and may be deeper there than `depth`,
/// and maybe others.
template <class Visit>
void visitParts(const PlacedEdge& edge, double depth, const Visit& visit)
{
    if (edge.second.distance.solid()) return visit(Part{0.0, edge.length});
    double seen = 0.0;
    for (Part part{0.0, 0.0}; part.from < edge.length && seen < edge.length;) {
        const auto hit = edge.second.rays.firstHit(edge.at(seen), edge.direction,
                                                   edge.length - seen, SurfaceRays::Facing::any);
        part.faces[1] = hit ? hit->triangle : -1;
        part.to = hit ? std::clamp(seen + hit->distance, seen, edge.length) : edge.length;
        // What is as deep is twice as long.
        if (part.to - part.from > 2.0 * depth && !isShallow(edge, part, depth) &&
            edge.distanceAt(0.5 * (part.from + part.to)) < 0.0) {
            visit(part);
        }
        part = {part.to, part.to, {part.faces[1], -1}};
        seen = part.from + depth;
    }
}

}  // namespace

bool comesWithin(const RelativePair& pair, const ConvexEdge& edge, double reach)
{
    const double least = std::min(kLeastWay * edge.length, std::max(reach, kRounding));
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
    visitParts(placed, -enough, [&](const Part& part) {
        double at = 0.0;
        const auto offer = [&](double along, double value) {
            if (value < least) {
                least = value;
                at = along;
            }
            return std::min(least, enough);
        };
        double step = kLeastWay * edge.length;
        const double before = least;
        lookAlong(placed, part, step, offer);
        if (least == before) return;
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
