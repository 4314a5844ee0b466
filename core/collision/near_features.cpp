#include "core/collision/near_features.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/collision/ball_contacts.h"
#include "core/collision/contact_list.h"
#include "core/math/lanes.h"

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 2.0;        // times the reach
constexpr double kLeastLookAhead = 0.05;  // times the bounding radius of the smaller body

using Part = ContactPart::Kind;

Segment placed(const RelativePair& pair, const ConvexEdge& edge)
{
    return {pair * edge.start, pair.rotation * edge.direction, edge.length};
}

/// Lower bound of the distance between what the tree of the first shape holds and the second.
double apartAtLeast(const RelativePair& pair, const SphereTree& ofFirst)
{
    double atLeast = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : ofFirst.cover()) {
        const double distance = pair.second.distance.lowerBound(pair * sphere.centre);
        atLeast = std::min(atLeast, distance - sphere.radius);
    }
    return atLeast;
}

/// One edge, or four.
template <class Number, class Vector>
struct FacingEdges {
    Vector middle, direction, intoFace[2], outward;
    Number half;  // of the length [m]
};
using EdgeLanes = FacingEdges<Lanes, Lanes3>;

Lanes3 everywhere(const Vec3& v)
{
    return Lanes3::of(v, v, v, v);
}

/// Edges of the second shape, four abreast.
void fillLanes(const ContactFeatures& features, const std::vector<std::int32_t>& chosen,
               std::vector<EdgeLanes>& lanes)
{
    constexpr double kNowhere = 1e100;
    lanes.resize((chosen.size() + kLanes - 1) / kLanes);
    for (std::size_t i = 0; i < lanes.size() * kLanes; ++i) {
        EdgeLanes& four = lanes[i / kLanes];
        const int lane = static_cast<int>(i % kLanes);
        if (i >= chosen.size()) {
            four.middle.set(lane, Vec3::Constant(kNowhere));
            continue;
        }
        const ConvexEdge& edge = features.edges()[chosen[i]];
        const double half = 0.5 * edge.length;
        four.half[lane] = half;
        four.middle.set(lane, edge.start + half * edge.direction);
        four.direction.set(lane, edge.direction);
        for (int k : {0, 1}) four.intoFace[k].set(lane, edge.intoFace[k]);
        four.outward.set(lane, edge.outward);
    }
}

EdgeLanes inAllLanes(const RelativePair& pair, const ConvexEdge& edge)
{
    const double half = 0.5 * edge.length;
    const auto turned = [&](const Vec3& v) { return everywhere(pair.rotation * v); };
    return {everywhere(pair * Vec3(edge.start + half * edge.direction)),
            turned(edge.direction),
            {turned(edge.intoFace[0]), turned(edge.intoFace[1])},
            turned(edge.outward),
            lanesOf(half)};
}

/// Which of four edges can come to touch one of the first shape while nothing moves by more than
/// `farthest` - no point, and no direction by more than `turn` [rad]: those that are near, and
/// whose common normal either supports (edgeSupports), give or take that turn. Most edges beside
/// each other never can.
unsigned mayFace(const EdgeLanes& ofA, const EdgeLanes& ofB, double farthest, double turn)
{
    const Lanes3 between = ofB.middle - ofA.middle;
    const Lanes far = ofA.half + ofB.half + farthest;
    const Lanes3 normal = cross(ofA.direction, ofB.direction);  // not unit; turns by `turn` at most
    const Lanes slack = kSupportSlack * sqrtOf(dot(normal, normal));
    const Lanes ofB0 = dot(ofB.intoFace[0], normal), ofB1 = dot(ofB.intoFace[1], normal);
    const Lanes ofA0 = dot(ofA.intoFace[0], normal), ofA1 = dot(ofA.intoFace[1], normal);
    const Lanes out = dot(ofB.outward, normal);
    const Lanes slackB = slack + (1.0 + kSupportSlack) * turn;
    const Lanes slackA = slack + (2.0 + kSupportSlack) * turn;
    const LaneMask isOut =
        (out >= -turn) & (maxOf(ofB0, ofB1) <= slackB) & (maxOf(-ofA0, -ofA1) <= slackA);
    const LaneMask isOutReversed =
        (out <= turn) & (maxOf(-ofB0, -ofB1) <= slackB) & (maxOf(ofA0, ofA1) <= slackA);
    return bitsOf((dot(between, between) <= far * far) & (isOut | isOutReversed));
}

/// Edges of the first shape that may come within `clearance` of the second, by index.
void findEdgesNear(const RelativePair& pair, double clearance, std::vector<std::int32_t>& near)
{
    near.clear();
    const ContactFeatures& features = pair.first.features;
    const auto isClear = [&](const Vec3& centre, double radius) {
        return pair.second.distance.isClearOf(pair * centre, radius + clearance);
    };
    features.edgeTree().visit(isClear, [&](std::uint32_t e) {
        const ConvexEdge& edge = features.edges()[e];
        const double half = 0.5 * edge.length;
        if (!isClear(edge.start + half * edge.direction, half))
            near.push_back(static_cast<std::int32_t>(e));
    });
    std::sort(near.begin(), near.end());
}

/// Of the points of the first body that turn in the frame of the second [m]. Seen from there
/// nothing else moves, so that no distance between the two changes faster. Of a plane only what is
/// near the second matters.
double leverOf(const RelativePair& pair)
{
    return pair.first.isPlane ? pair.second.boundingRadius + pair.translation.norm()
                              : pair.first.boundingRadius;
}

/// What an odometer counts of a way, at the least: the points of the first body turn with the
/// second on a longer lever than its own.
double countedOfWay(const RelativePair& pair)
{
    if (pair.first.isPlane || pair.second.isPlane) return 1.0;
    const double lever = pair.first.boundingRadius + pair.translation.norm();
    return std::min(1.0, pair.second.boundingRadius / lever);
}

}  // namespace

void NearFeatures::moveTo(const RelativePair& pair)
{
    // The norm of what two rotations differ by is √2 times the chord of a point at unit distance.
    const double chord = (pair.rotation - rotation_).norm() / std::numbers::sqrt2;
    way_ += (pair.translation - translation_).norm() + chord * leverOf(pair);
    rotation_ = pair.rotation;
    translation_ = pair.translation;
}

bool NearFeatures::isStale(double reach) const
{
    const double moved = way_ - lookedAt_;
    return !isKnown_ || moved > window_ || reach + moved > clearance_;
}

void NearFeatures::lookAtCorners(const RelativePair& pair, double clearance,
                                 std::vector<NearCorner>& near) const
{
    const ContactFeatures& features = pair.first.features;
    const SignedDistance& field = pair.second.distance;
    const auto isClear = [&](const Vec3& centre, double radius) {
        return field.isClearOf(pair * centre, radius + clearance);
    };
    features.cornerTree().visit(isClear, [&](std::uint32_t i) {
        const std::int32_t corner = features.corners()[i];
        const double atLeast = field.lowerBound(pair * features.points().col(corner));
        if (atLeast < clearance) near.push_back({way_ + atLeast, corner});
    });
    std::sort(near.begin(), near.end(),
              [](const NearCorner& p, const NearCorner& q) { return p.corner < q.corner; });
}

/// Edges may be deep in each other and still touch, so of two that are apart it also matters when
/// they can have crossed. Nearest points of segments wander: when no point moves farther than δ,
/// the line between those at distance d changes by up to δ + 2 √(δ(d + δ)). Until that is as much
/// as it points out of B, o, they are outside.
void NearFeatures::look(const Segment& ofA, const ConvexEdge& ofB, double deepest,
                        NearEdges& edges) const
{
    const SegmentGap gap = segmentGap(ofA, {ofB.start, ofB.direction, ofB.length});
    const double d = gap.distance;
    edges.farUntil = way_ + d;
    edges.outsideUntil = way_ + d - deepest;
    const double o = gap.between.dot(ofB.outward);
    if (o <= 0.0 || d > 2.0 * deepest) return;
    const double half = 2.0 * d + o;
    const double mayCrossAfter = (std::sqrt(half * half + 3.0 * o * o) - half) / 3.0;
    edges.outsideUntil = std::max(edges.outsideUntil, way_ + mayCrossAfter);
}

void NearFeatures::lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach)
{
    if (pair.first.features.edges().empty() || pair.second.features.edges().empty()) return;
    thread_local std::vector<std::int32_t> nearA, nearB;
    thread_local std::vector<EdgeLanes> ofB;
    findEdgesNear(pair, clearance_, nearA);
    if (nearA.empty()) return;
    findEdgesNear(back, clearance_, nearB);
    fillLanes(pair.second.features, nearB, ofB);
    const double deepest = deepestEdges(pair), end = way_ + window_;
    const double farthest = std::max(reach, deepest) + window_;
    const double turn = window_ / leverOf(pair);
    for (std::int32_t e : nearA) {
        const ConvexEdge& edge = pair.first.features.edges()[e];
        const Segment segment = placed(pair, edge);
        const EdgeLanes ofA = inAllLanes(pair, edge);
        for (std::size_t four = 0; four < ofB.size(); ++four) {
            for (unsigned bits = mayFace(ofA, ofB[four], farthest, turn); bits; bits &= bits - 1) {
                const std::int32_t other = nearB[four * kLanes + std::countr_zero(bits)];
                NearEdges edges{0.0, 0.0, e, other};
                look(segment, pair.second.features.edges()[other], deepest, edges);
                if (edges.farUntil - end < reach || edges.outsideUntil <= end)
                    edges_.push_back(edges);
            }
        }
    }
}

void NearFeatures::lookAgain(const RelativePair& pair, const RelativePair& back, double reach)
{
    isKnown_ = true;
    cornersOfA_.clear();
    cornersOfB_.clear();
    edges_.clear();
    lookedAt_ = way_;

    // Most pairs whose boxes meet are far apart: a few spheres say how far.
    clearance_ = std::min({apartAtLeast(pair, pair.first.features.cornerTree()),
                           apartAtLeast(back, back.first.features.cornerTree()),
                           back.first.features.edges().empty()
                               ? std::numeric_limits<double>::infinity()
                               : apartAtLeast(pair, pair.first.features.edgeTree())});
    window_ =
        std::max(kLookAhead * reach, kLeastLookAhead * smallerRadius(pair.first, pair.second));
    if (clearance_ > reach + window_) {
        window_ = clearance_;
        return;
    }
    clearance_ = reach + window_;
    lookAtCorners(pair, clearance_, cornersOfA_);
    lookAtCorners(back, clearance_, cornersOfB_);
    lookAtEdges(pair, back, reach);
}

void NearFeatures::findContacts(const PlacedPair& bodies, double reach,
                                std::vector<GapContact>& contacts, double odometer)
{
    const Shape &shapeA = *bodies.shapeA, &shapeB = *bodies.shapeB;
    const Mat3 worldFromA = bodies.worldFromA.orientation.toRotationMatrix();
    const Mat3 worldFromB = bodies.worldFromB.orientation.toRotationMatrix();
    const Vec3 offset = bodies.worldFromA.position - bodies.worldFromB.position;
    const RelativePair pair{shapeA, shapeB, worldFromB.transpose() * worldFromA,
                            worldFromB.transpose() * offset};
    const RelativePair back = pair.reversed();
    const ToWorld ofA{worldFromB, -offset, true}, ofB{worldFromA, Vec3::Zero(), false};
    const double smaller = smallerRadius(shapeA, shapeB);
    // Facets lie below the round surface that they stand for, and must be seen from farther away.
    const double bulge = shapeA.smooth.bulge() + shapeB.smooth.bulge();
    ContactList list(contacts, smaller, reach, bulge > 0.0);
    reach += bulge;

    if (isBall(shapeA) || isBall(shapeB)) {
        const bool isA = isBall(shapeA);
        const RelativePair& way = isA ? pair : back;
        thread_local std::vector<BallContact> found;
        findBallContacts(way, reach, found);
        for (const BallContact& ball : found) {
            const std::uint64_t feature =
                featureId(FeatureKind::ball, ball.place[0], ball.place[1]);
            list.add(way, {Part::ball}, {Part::face}, isA ? ofA : ofB, feature, ball.contact);
        }
        list.finish();
        return;
    }

    moveTo(pair);
    if (isStale(reach)) lookAgain(pair, back, reach);

    const double sharpness = kSharpness * smaller;
    double farUntil = lookedAt_ + std::min(clearance_, window_);  // of all features
    const auto faceCorners = [&](const RelativePair& way, std::vector<NearCorner>& near,
                                 FeatureKind kind, const ToWorld& toWorld) {
        for (NearCorner& candidate : near) {
            if (candidate.farUntil - way_ < reach) {
                const std::uint64_t feature = featureId(kind, candidate.corner);
                std::optional<FeatureContact> unsupported;
                if (const auto contact =
                        faceCorner(way, candidate.corner, reach, sharpness, unsupported)) {
                    list.add(way, {Part::corner, candidate.corner}, {Part::face}, toWorld, feature,
                             *contact);
                } else if (unsupported) {
                    list.addUnsupported(toWorld(feature, *unsupported));
                } else {
                    const Vec3 p = way * way.first.features.points().col(candidate.corner);
                    candidate.farUntil = way_ + way.second.distance.lowerBound(p);
                }
            }
            farUntil = std::min(farUntil, candidate.farUntil);
        }
    };
    faceCorners(pair, cornersOfA_, FeatureKind::cornerOfA, ofA);
    faceCorners(back, cornersOfB_, FeatureKind::cornerOfB, ofB);
    const double deepest = deepestEdges(pair);
    for (NearEdges& candidate : edges_) {
        if (candidate.farUntil - way_ < reach || candidate.outsideUntil <= way_) {
            const auto contact = faceEdges(pair, candidate.ofA, candidate.ofB, reach, sharpness);
            if (contact) {
                const auto feature = featureId(FeatureKind::edges, candidate.ofA, candidate.ofB);
                list.add(pair, {Part::edge, candidate.ofA}, {Part::edge, candidate.ofB}, ofA,
                         feature, *contact);
            } else {
                look(placed(pair, shapeA.features.edges()[candidate.ofA]),
                     shapeB.features.edges()[candidate.ofB], deepest, candidate);
            }
        }
        const double outside = (candidate.outsideUntil - way_) * countedOfWay(pair);
        farUntil = std::min({farUntil, candidate.farUntil, way_ + outside});
    }
    list.finish();
    apart_ = farUntil - way_ - bulge;
    odometerThen_ = odometer;
}

}  // namespace scree
