#include "core/collision/edge_inside.h"

#include <algorithm>
#include <limits>

namespace scree {
namespace {

constexpr double kRounding = 1e-9;  // of lengths
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastWay = 0.01;  // along an edge, of its length

/// Places along an edge of the first, told to look(along, distance from the second), which answers
/// below what distance others matter: those that can be nearer are told of, but for what is
/// shorter than `least` [m].
///
/// Around a place at distance d nothing is nearer than `below` for d - below to either side. Beside
/// a surface the next place is about as far away: so its other half is counted on, and only where
/// that leaves something uncovered the next place is where the first half ends [KSK14].
template <class Look>
void lookAlong(const RelativePair& pair, const ConvexEdge& edge, double least, const Look& look)
{
    const Vec3 start = pair * edge.start, direction = pair.rotation * edge.direction;
    const SignedDistance& field = pair.second.distance;
    double known = 0.0, half = 0.0;  // so far everything is known, beyond half as much is hoped for
    while (known < edge.length) {
        const double along = std::min(known + half, edge.length);
        const Vec3 place = start + along * direction;
        const double value = field.value(place), below = look(along, value);
        // Of values far away nobody knows whether they are above the true distance.
        const double apart = value < field.refinementBand() ? value : field.lowerBound(place);
        const double free = std::max(apart - below, 0.5 * least);
        if (along - free > known) {
            half = 0.0;
            continue;
        }
        known = along + free;
        half = free;
    }
}

}  // namespace

bool comesWithin(const RelativePair& pair, const ConvexEdge& edge, double reach)
{
    const double least = std::min(kLeastWay * edge.length, std::max(reach, kRounding));
    bool isNear = false;
    lookAlong(pair, edge, least, [&](double, double apart) {
        isNear = isNear || apart < reach;
        return isNear ? -kInfinity : reach;  // nothing else matters
    });
    return isNear;
}

double deepestAlong(const RelativePair& pair, const ConvexEdge& edge, double near, double enough)
{
    constexpr int kHalvings = 10;
    const Vec3 start = pair * edge.start, direction = pair.rotation * edge.direction;
    double least = kInfinity, at = 0.0;
    const auto offer = [&](double along, double value) {
        if (value < least) {
            least = value;
            at = along;
        }
        return std::min(least, enough);
    };
    const auto look = [&](double along) {
        const double place = std::clamp(along, 0.0, edge.length);
        offer(place, pair.second.distance.value(start + place * direction));
    };
    look(near);
    double step = kLeastWay * edge.length;
    lookAlong(pair, edge, step, offer);
    // The last halving ends within two steps of here.
    for (int i = 0; i < kHalvings && least - 2.0 * step < enough; ++i, step *= 0.5) {
        const double middle = at;
        look(middle - step);
        look(middle + step);
    }
    return least;
}

}  // namespace scree
