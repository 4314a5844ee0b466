// Symbols: s and t places along the edges of the first and of the second.
#include "core/collision/edge_lanes.h"

#include "core/collision/feature_contacts.h"

namespace scree {
namespace {

/// What faceEdges sees an edge reach beyond its end, or an angle, is what is seen here but for
/// rounding: this share of the lengths, and of one.
constexpr double kRounding = 1e-6;

Lanes clamped(Lanes x, Lanes most)
{
    return minOf(maxOf(x, kNoLanes), most);
}

/// Of edges from points, seen from their middles [m²].
FloatLanes squaredDistance(const FacingLanes& edge, const FloatLanes3& fromMiddle)
{
    const FloatLanes along = dot(fromMiddle, edge.direction);
    const FloatLanes t = minOf(maxOf(along, -edge.half), edge.half);
    const FloatLanes3 away = fnma(t, edge.direction, fromMiddle);
    return dot(away, away);
}

FloatLanes3 allOf(const FloatLanes3& v, int lane)
{
    return {FloatLanes{} + v.x[lane], FloatLanes{} + v.y[lane], FloatLanes{} + v.z[lane]};
}

}  // namespace

FacingLanes FacingLanes::all(int lane) const
{
    return {allOf(middle, lane),
            allOf(direction, lane),
            allOf(outward, lane),
            {allOf(intoFace[0], lane), allOf(intoFace[1], lane)},
            FloatLanes{} + half[lane]};
}

Sphere FacingLanes::around() const
{
    const Vec3 centre = Vec3(sumOf(middle.x), sumOf(middle.y), sumOf(middle.z)) / kFloatLanes;
    const FloatLanes3 way = middle - FloatLanes3::all(centre);
    return {centre, largestOf(sqrtOf(dot(way, way)) + half)};
}

FacingLanes FacingLanes::placed(const Mat3& rotation, const Vec3& translation) const
{
    const RotationLanes turned(rotation);
    return {turned * middle + FloatLanes3::all(translation),
            turned * direction,
            turned * outward,
            {turned * intoFace[0], turned * intoFace[1]},
            half};
}

unsigned mayFace(const FacingLanes& ofFirst, const FacingLanes& ofSecond, double farthest,
                 double turn)
{
    const FacingLanes &a = ofFirst, &b = ofSecond;
    const FloatLanes3 between = b.middle - a.middle;
    const FloatLanes far = floatLanesOf(farthest);
    const FloatLanes farA = a.half + far, farB = b.half + far, farAll = farA + b.half;
    if (!bitsOf(dot(between, between) <= farAll * farAll)) return 0;
    const IntLanes isNear = (squaredDistance(a, between) <= farB * farB) &
                            (squaredDistance(b, FloatLanes3{} - between) <= farA * farA);
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
EdgeGaps edgeGaps(const SegmentLanes& ofFirst, const EdgeLanes& ofSecond, double deepest,
                  double reach)
{
    const SegmentLanes& a = ofFirst;
    const EdgeLanes& b = ofSecond;
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
    const Lanes3 nearest = fnma(t, b.direction, fma(s, a.direction, between));
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
