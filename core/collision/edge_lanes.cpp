// Symbols: s and t places along the edges of the first and of the second.
#include "core/collision/edge_lanes.h"

#include "core/collision/feature_contacts.h"

namespace scree {
namespace {

/// What faceEdges sees an edge reach beyond its end, or an angle, is what is seen here but for
/// rounding: this share of the lengths, and of one.
constexpr double kRounding = 1e-6;

template <class L>
L clamped(L x, L most)
{
    return minOf(maxOf(x, L{}), most);
}

/// Whether edges come as near to a point as `far`.
IntLanes passesWithin(const FacingLanes& edge, const FloatLanes3& point, FloatLanes far)
{
    const FloatLanes3 to = point - edge.start;
    const FloatLanes3 away = to - clamped(dot(to, edge.direction), edge.length) * edge.direction;
    return dot(away, away) <= far * far;
}

}  // namespace

unsigned mayFace(const FacingLanes& ofFirst, const FacingLanes& ofSecond, double farthest,
                 double turn)
{
    const FacingLanes &a = ofFirst, &b = ofSecond;
    const FloatLanes halfA = 0.5f * a.length, halfB = 0.5f * b.length;
    const FloatLanes3 middleA = a.start + halfA * a.direction;
    const FloatLanes3 middleB = b.start + halfB * b.direction;
    const IntLanes isNear = passesWithin(a, middleB, halfB + floatLanesOf(farthest)) &
                            passesWithin(b, middleA, halfA + floatLanesOf(farthest));
    if (!bitsOf(isNear)) return 0;
    const FloatLanes3 normal = cross(a.direction, b.direction);  // not unit; turns by `turn`
    const FloatLanes slack = static_cast<float>(kSupportSlack) * sqrtOf(dot(normal, normal));
    const FloatLanes ofB0 = dot(b.intoFace[0], normal), ofB1 = dot(b.intoFace[1], normal);
    const FloatLanes ofA0 = dot(a.intoFace[0], normal), ofA1 = dot(a.intoFace[1], normal);
    const FloatLanes out = dot(b.outward, normal), mayTurn = floatLanesOf(turn);
    const FloatLanes slackB = slack + floatLanesOf((1.0 + kSupportSlack) * turn);
    const FloatLanes slackA = slack + floatLanesOf((2.0 + kSupportSlack) * turn);
    const IntLanes isOut =
        (out >= -mayTurn) & (maxOf(ofB0, ofB1) <= slackB) & (maxOf(-ofA0, -ofA1) <= slackA);
    const IntLanes isOutReversed =
        (out <= mayTurn) & (maxOf(-ofB0, -ofB1) <= slackB) & (maxOf(ofA0, ofA1) <= slackA);
    return bitsOf(isNear & (isOut | isOutReversed));
}

/// Edges may be deep in each other and still touch, so of two that are apart it also matters when
/// they can have crossed. Nearest points of segments wander: when no point moves farther than δ,
/// the line between those at distance d changes by up to δ + 2 √(δ(d + δ)). Until that is as much
/// as it points out of the second, o, they are outside.
EdgeGaps edgeGaps(const EdgeLanes& ofFirst, const EdgeLanes& ofSecond, double deepest, double reach)
{
    const EdgeLanes &a = ofFirst, &b = ofSecond;
    const Lanes3 between = a.start - b.start;
    const Lanes cosine = dot(a.direction, b.direction);
    const Lanes alongA = dot(a.direction, between), alongB = dot(b.direction, between);
    const Lanes sineSquared = 1.0 - cosine * cosine;
    const LaneMask isParallel = sineSquared < lanesOf(kParallel * kParallel);
    const Lanes lineS = (cosine * alongB - alongA) / sineSquared;
    const Lanes lineT = (alongB - cosine * alongA) / sineSquared;

    const Lanes firstS = isParallel ? kNoLanes : clamped(lineS, a.length);
    const Lanes t = clamped(alongB + firstS * cosine, b.length);
    const Lanes s = clamped(t * cosine - alongA, a.length);
    const Lanes3 nearest = between + s * a.direction - t * b.direction;
    EdgeGaps gaps;
    gaps.distance = sqrtOf(dot(nearest, nearest)) - (isParallel ? kParallel * a.length : kNoLanes);
    const Lanes d = gaps.distance, o = dot(nearest, b.outward);
    const Lanes half = 2.0 * d + o;
    const Lanes mayCross = (sqrtOf(half * half + 3.0 * o * o) - half) / 3.0;
    const LaneMask isOutside = (o > kNoLanes) & (d <= lanesOf(2.0 * deepest));
    gaps.outside = d - deepest;
    gaps.outside = isOutside ? maxOf(gaps.outside, mayCross) : gaps.outside;

    // Where their lines are closest, beyond the ends no farther than they overlap.
    const Lanes3 normal = cross(a.direction, b.direction);
    const Lanes sine = sqrtOf(dot(normal, normal)), out = dot(normal, b.outward) / sine;
    const Lanes apart = dot(normal, between) / sine;
    const Lanes towardsSecond = absOf(out) < lanesOf(kRounding) ? -absOf(apart)
                                : out < kNoLanes                ? -apart
                                                                : apart;
    const Lanes beyond = maxOf(maxOf(-lineS, lineS - a.length), kNoLanes) +
                         maxOf(maxOf(-lineT, lineT - b.length), kNoLanes);
    const Lanes rounding = kRounding * (a.length + b.length);
    gaps.mayTouch = (sineSquared >= lanesOf((1.0 - kRounding) * kParallel * kParallel)) &
                    (towardsSecond < reach + rounding) &
                    (beyond <= maxOf(-towardsSecond, kNoLanes) + rounding);
    return gaps;
}

}  // namespace scree
