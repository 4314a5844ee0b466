// Symbols: s and t places along the edges of the first and of the second.
#include "core/collision/edge_lanes.h"

#include <cmath>

#include "core/collision/edge_contacts.h"

namespace scree {
namespace {

/// Of a unit direction, a few operations on.
constexpr float kDirection = 1e-6f;

FloatLanes clamped(FloatLanes x, FloatLanes most)
{
    return minOf(maxOf(x, FloatLanes{}), most);
}

/// Four of the numbers of eight edges, from `first` on, as four columns of eight.
std::array<FloatLanes, 4> columns(const EightEdges& edges, std::size_t first)
{
    const auto row = [&](std::size_t i) { return _mm_load_ps(&edges[i]->numbers[first]); };
    const auto both = [&](std::size_t i) { return _mm256_set_m128(row(i + 4), row(i)); };
    const __m256 r0 = both(0), r1 = both(1), r2 = both(2), r3 = both(3);
    const __m256 low01 = _mm256_unpacklo_ps(r0, r1), high01 = _mm256_unpackhi_ps(r0, r1);
    const __m256 low23 = _mm256_unpacklo_ps(r2, r3), high23 = _mm256_unpackhi_ps(r2, r3);
    return {_mm256_shuffle_ps(low01, low23, 0x44), _mm256_shuffle_ps(low01, low23, 0xee),
            _mm256_shuffle_ps(high01, high23, 0x44), _mm256_shuffle_ps(high01, high23, 0xee)};
}

/// Of edges from points, seen from their middles [m²].
FloatLanes squaredDistance(const FacingLanes& edge, const FloatLanes3& fromMiddle)
{
    const FloatLanes along = dot(fromMiddle, edge.direction);
    const FloatLanes t = minOf(maxOf(along, -edge.half), edge.half);
    const FloatLanes3 away = fnma(t, edge.direction, fromMiddle);
    return dot(away, away);
}

/// Whether a direction from which one of a pair can be touched is opposed to one of the other, when
/// either has turned by `turn` [rad].
IntLanes mayOppose(const FacingLanes& a, const FacingLanes& b, double turn)
{
    const FloatLanes cosine = a.cosine * b.cosine - a.sine * b.sine;
    const FloatLanes sine = a.sine * b.cosine + a.cosine * b.sine;
    // Angles of more than half a turn together hold opposed directions whatever they lie around.
    return (sine <= 0.0f) | (dot(a.outward, b.outward) + cosine <= floatLanesOf(turn + kDirection));
}

FloatLanes3 allOf(const FloatLanes3& v, int lane)
{
    return {FloatLanes{} + v.x[lane], FloatLanes{} + v.y[lane], FloatLanes{} + v.z[lane]};
}

}  // namespace

FacingLanes::FacingLanes(const EightEdges& edges)
{
    const auto c0 = columns(edges, 0), c4 = columns(edges, 4), c8 = columns(edges, 8),
               c12 = columns(edges, 12);
    half = 0.5f * absOf(c0[3]);
    touchBetweenEnds = c0[3] < 0.0f;
    direction = {c4[0], c4[1], c4[2]};
    middle = fma(half, direction, FloatLanes3{c0[0], c0[1], c0[2]});
    outward = {c4[3], c8[0], c8[1]};
    intoFace[0] = {c8[2], c8[3], c12[0]};
    intoFace[1] = {c12[1], c12[2], c12[3]};
    // Half the bend, and the slack.
    constexpr auto slack = static_cast<float>(kSupportSlack);
    const float rest = std::sqrt(1.0f - slack * slack);
    const FloatLanes ofBend = 0.5f * dot(intoFace[0], intoFace[1]);
    const FloatLanes cosineOfHalf = sqrtOf(maxOf(0.5f - ofBend, FloatLanes{}));
    const FloatLanes sineOfHalf = sqrtOf(maxOf(0.5f + ofBend, FloatLanes{}));
    cosine = rest * cosineOfHalf - slack * sineOfHalf;
    sine = rest * sineOfHalf + slack * cosineOfHalf;
}

FacingLanes FacingLanes::all(int lane) const
{
    FacingLanes one;
    one.middle = allOf(middle, lane);
    one.direction = allOf(direction, lane);
    one.outward = allOf(outward, lane);
    for (int k : {0, 1}) one.intoFace[k] = allOf(intoFace[k], lane);
    one.cosine = FloatLanes{} + cosine[lane];
    one.sine = FloatLanes{} + sine[lane];
    one.half = FloatLanes{} + half[lane];
    one.touchBetweenEnds = IntLanes{} + touchBetweenEnds[lane];
    return one;
}

Ball FacingLanes::around() const
{
    const Vec3 centre = Vec3(sumOf(middle.x), sumOf(middle.y), sumOf(middle.z)) / kFloatLanes;
    const FloatLanes3 way = middle - FloatLanes3::all(centre);
    return {centre, largestOf(sqrtOf(dot(way, way)) + half)};
}

FacingLanes FacingLanes::placed(const Mat3& rotation, const Vec3& translation) const
{
    const RotationLanes turned(rotation);
    FacingLanes there;
    there.middle = turned * middle + FloatLanes3::all(translation);
    there.direction = turned * direction;
    there.outward = turned * outward;
    for (int k : {0, 1}) there.intoFace[k] = turned * intoFace[k];
    there.cosine = cosine;
    there.sine = sine;
    there.half = half;
    there.touchBetweenEnds = touchBetweenEnds;
    return there;
}

/// Let w be the way between the points where lines are to be nearest, no longer than δ then. It is
/// square to both edges then, and now, before its ends have moved by m and an edge has turned by φ,
/// it goes along one by no more than m, and along the other by m + δ φ. So these points lie from
/// where the lines are nearest now by at most (m (1 + |cosine|) + δ φ) / sine².
unsigned mayFace(const FacingLanes& ofFirst, const FacingLanes& ofSecond, const FacingReach& reach)
{
    const FacingLanes &a = ofFirst, &b = ofSecond;
    const IntLanes areOpposed = mayOppose(a, b, reach.turn);
    if (!bitsOf(areOpposed)) return 0;
    const FloatLanes3 between = b.middle - a.middle;
    const FloatLanes far = floatLanesOf(reach.touching + reach.way);
    const FloatLanes farA = a.half + far, farB = b.half + far, farAll = farA + b.half;
    if (!bitsOf(dot(between, between) <= farAll * farAll)) return 0;
    const IntLanes isNear = (squaredDistance(a, between) <= farB * farB) &
                            (squaredDistance(b, FloatLanes3{} - between) <= farA * farA);
    if (!bitsOf(isNear)) return 0;
    const FloatLanes3 normal = cross(a.direction, b.direction);  // not unit; turns by `turn`
    const FloatLanes slack = static_cast<float>(kSupportSlack) * sqrtOf(dot(normal, normal));
    const FloatLanes ofB0 = dot(b.intoFace[0], normal), ofB1 = dot(b.intoFace[1], normal);
    const FloatLanes ofA0 = dot(a.intoFace[0], normal), ofA1 = dot(a.intoFace[1], normal);
    const FloatLanes out = dot(b.outward, normal), mayTurn = floatLanesOf(reach.turn);
    const FloatLanes slackB = slack + floatLanesOf((1.0 + kSupportSlack) * reach.turn);
    const FloatLanes slackA = slack + floatLanesOf((2.0 + kSupportSlack) * reach.turn);
    const IntLanes isOut =
        (out >= -mayTurn) & (maxOf(ofB0, ofB1) <= slackB) & (maxOf(-ofA0, -ofA1) <= slackA);
    const IntLanes isOutReversed =
        (out <= mayTurn) & (maxOf(-ofB0, -ofB1) <= slackB) & (maxOf(ofA0, ofA1) <= slackA);
    const IntLanes mayMeet = areOpposed & isNear & (isOut | isOutReversed);
    if (!bitsOf(mayMeet)) return 0;

    const FloatLanes sineSquared = dot(normal, normal), cosine = dot(a.direction, b.direction);
    const FloatLanes alongA = dot(a.direction, between), alongB = dot(b.direction, between);
    const FloatLanes s = absOf(fnma(cosine, alongB, alongA));  // times sine², from the middle
    const FloatLanes t = absOf(fnma(cosine, alongA, alongB));
    const FloatLanes wanders =
        fma(floatLanesOf(reach.way), 1.0f + absOf(cosine), far * floatLanesOf(reach.turn));
    const IntLanes isBeside = (a.touchBetweenEnds & (s > fma(a.half, sineSquared, wanders))) |
                              (b.touchBetweenEnds & (t > fma(b.half, sineSquared, wanders)));
    return bitsOf(mayMeet & ~isBeside);
}

LineLanes::LineLanes(const EightEdges& edges)
{
    const auto c0 = columns(edges, 0), c4 = columns(edges, 4), c8 = columns(edges, 8);
    start = {c0[0], c0[1], c0[2]};
    length = absOf(c0[3]);
    touchBetweenEnds = c0[3] < 0.0f;
    direction = {c4[0], c4[1], c4[2]};
    outward = {c4[3], c8[0], c8[1]};
}

void LineLanes::place(const RotationLanes& rotation, const FloatLanes3& translation)
{
    start = rotation * start + translation;
    direction = rotation * direction;
}

/// Edges may be deep in each other and still touch, so of two that are apart it also matters when
/// they can have crossed. Nearest points of segments wander: when no point moves farther than δ,
/// the line between those at distance d changes by up to δ + 2 √(δ(d + δ)). Until that is as much
/// as it points out of the second, o, they are outside.
///
/// What rounding ρ does grows as lines get parallel: where they are nearest is wrong by ρ / sine²
/// or the length of the segment, their distance by sine times that; and two places that are e
/// farther apart than the nearest lie √(e (2 d + e)) beside them.
EdgeGaps edgeGaps(const LineLanes& ofFirst, const LineLanes& ofSecond, double deepest, double reach,
                  double rounding)
{
    const LineLanes &a = ofFirst, &b = ofSecond;
    const FloatLanes wrong = floatLanesOf(rounding), none = {};
    const FloatLanes3 between = a.start - b.start;
    const FloatLanes3 normal = cross(a.direction, b.direction);
    const FloatLanes cosine = dot(a.direction, b.direction);
    const FloatLanes alongA = dot(a.direction, between), alongB = dot(b.direction, between);
    const FloatLanes sineSquared = maxOf(dot(normal, normal), floatLanesOf(1e-12));
    const FloatLanes sine = sqrtOf(sineSquared);
    const FloatLanes lineS = (cosine * alongB - alongA) / sineSquared;
    const FloatLanes lineT = (alongB - cosine * alongA) / sineSquared;
    const FloatLanes lineWrong = 2.0f * wrong / sineSquared;

    const FloatLanes t = clamped(fma(clamped(lineS, a.length), cosine, alongB), b.length);
    const FloatLanes s = clamped(fma(t, cosine, -alongA), a.length);
    const FloatLanes3 nearest = fnma(t, b.direction, fma(s, a.direction, between));
    const FloatLanes d = sqrtOf(dot(nearest, nearest));
    const FloatLanes tooFar = wrong + sine * minOf(lineWrong, a.length);
    EdgeGaps gaps;
    gaps.distance = d - tooFar;
    const FloatLanes aside = sqrtOf(tooFar * (2.0f * d + tooFar));
    const FloatLanes o = dot(nearest, b.outward) - aside - wrong;
    const FloatLanes half = 2.0f * d + o;
    const FloatLanes mayCross = o * o / (sqrtOf(fma(half, half, 3.0f * o * o)) + half + wrong);
    const IntLanes isOutside = (o > none) & (d <= floatLanesOf(2.0 * deepest));
    gaps.outside = gaps.distance - floatLanesOf(deepest);
    gaps.outside = isOutside ? maxOf(gaps.outside, mayCross) : gaps.outside;

    // Where their lines are closest, not far beyond the ends for what they overlap.
    const FloatLanes out = dot(normal, b.outward), apart = dot(normal, between) / sine;
    const FloatLanes towardsSecond = maxOf(out, -out) < floatLanesOf(kDirection)
                                         ? -maxOf(apart, -apart)
                                     : out < none ? -apart
                                                  : apart;
    const FloatLanes beyondA = maxOf(maxOf(-lineS, lineS - a.length), none);
    const FloatLanes beyondB = maxOf(maxOf(-lineT, lineT - b.length), none);
    const IntLanes isBeside =
        (a.touchBetweenEnds & (beyondA > lineWrong)) | (b.touchBetweenEnds & (beyondB > lineWrong));
    const FloatLanes slack = 2.0f * lineWrong + 2.0f * wrong / sine;
    const FloatLanes pastEnds =
        static_cast<float>(kPastEnds) * (maxOf(-towardsSecond, none) + slack);
    gaps.mayTouch = (sine >= floatLanesOf(0.99 * kParallel)) &
                    (towardsSecond < floatLanesOf(reach) + slack) &
                    (beyondA + beyondB <= pastEnds) & ~isBeside;
    return gaps;
}

}  // namespace scree
