#include "core/collision/near_features.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/collision/ball_contacts.h"
#include "core/collision/contact_list.h"
#include "core/collision/contact_reduction.h"
#include "core/collision/edge_lanes.h"
#include "core/geometry/distance_lanes.h"

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 0.6;        // times the reach
constexpr double kLeastLookAhead = 0.05;  // times the bounding radius of the smaller body

using Part = ContactPart::Kind;

RelativePair relativePair(const PlacedPair& bodies, const Mat3& worldFromA, const Mat3& worldFromB)
{
    const Vec3 offset = bodies.worldFromA.position - bodies.worldFromB.position;
    return {*bodies.shapeA, *bodies.shapeB, worldFromB.transpose() * worldFromA,
            worldFromB.transpose() * offset};
}

/// Facets lie below the round surface that they stand for, and must be seen from farther away.
double bulgeOf(const RelativePair& pair)
{
    return pair.first.smooth.bulge() + pair.second.smooth.bulge();
}

/// Lower bound of the distance between what the spheres hold and the field.
double apartAtLeast(const DistanceLanes& field, const std::vector<SphereLanes>& cover)
{
    FloatLanes atLeast = floatLanesOf(std::numeric_limits<float>::infinity());
    for (const SphereLanes& spheres : cover) atLeast = minOf(atLeast, field.apartAtLeast(spheres));
    float least = atLeast[0];
    for (int lane = 1; lane < kFloatLanes; ++lane) least = std::min(least, atLeast[lane]);
    return least;
}

/// The second shape asked about features of the first.
DistanceLanes fieldOfSecond(const RelativePair& pair)
{
    return {pair.second.distance, pair.rotation, pair.translation, pair.first.boundingRadius};
}

double apartAtLeast(const RelativePair& pair, const RelativePair& back)
{
    const ContactFeatures &first = pair.first.features, &second = back.first.features;
    const DistanceLanes ofSecond = fieldOfSecond(pair), ofFirst = fieldOfSecond(back);
    double atLeast = std::min(apartAtLeast(ofSecond, first.cornerTree().cover()),
                              apartAtLeast(ofFirst, second.cornerTree().cover()));
    if (!second.edges().empty())
        atLeast = std::min(atLeast, apartAtLeast(ofSecond, first.edgeTree().cover()));
    return atLeast;
}

/// Edges of the first shape that may come within `clearance` of the second, in the order of their
/// tree, where what is near each other is next to each other.
void findEdgesNear(const RelativePair& pair, double clearance, std::vector<std::int32_t>& near)
{
    near.clear();
    const DistanceLanes field = fieldOfSecond(pair);
    pair.first.features.edgeTree().visit(
        [&](const SphereLanes& spheres) { return field.mayBeWithin(clearance, spheres); },
        [&](std::uint32_t e, int) { near.push_back(static_cast<std::int32_t>(e)); });
}

void inEights(const std::vector<ConvexEdge>& edges, const std::vector<std::int32_t>& chosen,
              std::vector<FacingLanes>& eights)
{
    eights.resize((chosen.size() + kFloatLanes - 1) / kFloatLanes);
    for (std::size_t i = 0; i < chosen.size(); ++i)
        eights[i / kFloatLanes].set(static_cast<int>(i % kFloatLanes), edges[chosen[i]]);
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

double apartAtLeast(const PlacedPair& bodies)
{
    const RelativePair pair = relativePair(bodies, bodies.worldFromA.orientation.toRotationMatrix(),
                                           bodies.worldFromB.orientation.toRotationMatrix());
    const RelativePair back = pair.reversed();
    const auto ofBall = [](const RelativePair& way) {
        return way.second.distance.lowerBound(way.translation) - way.first.boundingRadius;
    };
    const double apart = isBall(pair.first)    ? ofBall(pair)
                         : isBall(pair.second) ? ofBall(back)
                                               : apartAtLeast(pair, back);
    return apart - bulgeOf(pair);
}

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
    const DistanceLanes field = fieldOfSecond(pair);
    FloatLanes atLeast;
    features.cornerTree().visit(
        [&](const SphereLanes& spheres) {
            atLeast = field.apartAtLeast(spheres);
            return bitsOf(atLeast < floatLanesOf(clearance));
        },
        [&](std::uint32_t i, int lane) {
            near.push_back({way_ + atLeast[lane], features.corners()[i]});
        });
}

void NearFeatures::lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach)
{
    const ContactFeatures &first = pair.first.features, &second = pair.second.features;
    if (first.edges().empty() || second.edges().empty()) return;
    thread_local std::vector<std::int32_t> nearA, nearB;
    thread_local std::vector<FacingLanes> eightsOfA, eightsOfB;
    findEdgesNear(pair, clearance_, nearA);
    if (nearA.empty()) return;
    findEdgesNear(back, clearance_, nearB);
    inEights(first.edges(), nearA, eightsOfA);
    inEights(second.edges(), nearB, eightsOfB);

    const double rounding =
        kSinglePrecision * (pair.first.boundingRadius + pair.translation.norm());
    const double farthest = std::max(reach, deepestEdges(pair)) + window_ + rounding;
    const double turn = window_ / leverOf(pair) + kSinglePrecision;
    for (FacingLanes& eight : eightsOfA) eight = eight.placed(pair.rotation, pair.translation);
    for (std::size_t a = 0; a < nearA.size(); ++a) {
        const FacingLanes edge = eightsOfA[a / kFloatLanes].all(static_cast<int>(a % kFloatLanes));
        for (std::size_t eight = 0; eight < eightsOfB.size(); ++eight) {
            unsigned bits = mayFace(edge, eightsOfB[eight], farthest, turn);
            for (; bits; bits &= bits - 1) {
                const std::size_t b =
                    kFloatLanes * eight + static_cast<std::size_t>(std::countr_zero(bits));
                if (b >= nearB.size()) break;
                edges_.push_back({way_, way_, nearA[a], nearB[b]});
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
    clearance_ = apartAtLeast(pair, back);
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

void NearFeatures::touchEdges(const RelativePair& pair, const ToWorld& toWorld, double reach,
                              ContactList& list)
{
    if (edges_.empty()) return;
    const double deepest = deepestEdges(pair);
    const double sharpness = kSharpness * smallerRadius(pair.first, pair.second);
    const std::vector<ConvexEdge>& first = pair.first.features.edges();
    const std::vector<ConvexEdge>& second = pair.second.features.edges();
    struct Placed {
        std::int32_t edge = -1;
        Vec3 start, direction;
        double length;
    };
    std::array<Placed, kLanes> placed;  // edges of the first come several times running
    std::size_t last = 0;
    std::array<const Placed*, kLanes> ofFirst;
    std::array<const ConvexEdge*, kLanes> ofSecond;
    std::array<NearEdges*, kLanes> four;
    std::size_t filled = 0;
    const auto flush = [&] {
        for (std::size_t idle = filled; idle < kLanes; ++idle) {
            ofFirst[idle] = ofFirst[0];
            ofSecond[idle] = ofSecond[0];
        }
        const EdgeGaps gaps = edgeGaps(SegmentLanes(ofFirst), EdgeLanes(ofSecond), deepest, reach);
        const unsigned mayTouch = bitsOf(gaps.mayTouch);
        for (std::size_t lane = 0; lane < filled; ++lane) {
            NearEdges& edges = *four[lane];
            edges.farUntil = way_ + gaps.distance[lane];
            edges.outsideUntil = way_ + gaps.outside[lane];
            if (!(mayTouch >> lane & 1u)) continue;
            const auto contact = faceEdges(pair, edges.ofA, edges.ofB, reach, sharpness);
            if (!contact) continue;
            list.add(pair, {Part::edge, edges.ofA}, {Part::edge, edges.ofB}, toWorld,
                     featureId(FeatureKind::edges, edges.ofA, edges.ofB), *contact);
        }
        filled = 0;
    };
    for (NearEdges& edges : edges_) {
        if (edges.farUntil - way_ >= reach && edges.outsideUntil > way_) continue;
        if (edges.ofA != placed[last].edge) {
            last = (last + 1) % kLanes;
            const ConvexEdge& edge = first[edges.ofA];
            placed[last] = {edges.ofA, pair * edge.start, pair.rotation * edge.direction,
                            edge.length};
        }
        ofFirst[filled] = &placed[last];
        ofSecond[filled] = &second[edges.ofB];
        four[filled++] = &edges;
        if (filled == kLanes) flush();
    }
    if (filled > 0) flush();
}

void NearFeatures::findContacts(const PlacedPair& bodies, double reach,
                                std::vector<GapContact>& contacts, double odometer)
{
    const Shape &shapeA = *bodies.shapeA, &shapeB = *bodies.shapeB;
    const Mat3 worldFromA = bodies.worldFromA.orientation.toRotationMatrix();
    const Mat3 worldFromB = bodies.worldFromB.orientation.toRotationMatrix();
    const RelativePair pair = relativePair(bodies, worldFromA, worldFromB);
    const RelativePair back = pair.reversed();
    const Vec3 bFromA = bodies.worldFromB.position - bodies.worldFromA.position;
    const ToWorld ofA{worldFromB, bFromA, true}, ofB{worldFromA, Vec3::Zero(), false};
    const double smaller = smallerRadius(shapeA, shapeB);
    const double bulge = bulgeOf(pair);
    const std::size_t known = contacts.size();
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
    const bool isNew = isStale(reach);
    if (isNew) lookAgain(pair, back, reach);

    const double sharpness = kSharpness * smaller;
    double farUntil = lookedAt_ + std::min(clearance_, window_);  // of all features
    const auto faceCorners = [&](const RelativePair& way, std::vector<NearCorner>& near,
                                 FeatureKind kind, const ToWorld& toWorld) {
        for (NearCorner& candidate : near) {
            if (candidate.farUntil - way_ < reach) {
                const std::uint64_t feature = featureId(kind, candidate.corner);
                const FacedCorner faced = faceCorner(way, candidate.corner, reach, sharpness);
                candidate.farUntil = way_ + faced.apart;
                if (faced.contact) {
                    list.add(way, {Part::corner, candidate.corner}, {Part::face}, toWorld, feature,
                             *faced.contact);
                } else if (faced.unsupported) {
                    list.addUnsupported(toWorld(feature, *faced.unsupported));
                }
            }
            farUntil = std::min(farUntil, candidate.farUntil);
        }
    };
    faceCorners(pair, cornersOfA_, FeatureKind::cornerOfA, ofA);
    faceCorners(back, cornersOfB_, FeatureKind::cornerOfB, ofB);
    touchEdges(pair, ofA, reach, list);
    if (isNew) {
        const double end = lookedAt_ + window_;
        std::erase_if(edges_, [&](const NearEdges& edges) {
            return edges.farUntil - end >= reach && edges.outsideUntil > end;
        });
    }
    double outsideUntil = std::numeric_limits<double>::infinity();
    for (const NearEdges& candidate : edges_) {
        farUntil = std::min(farUntil, candidate.farUntil);
        outsideUntil = std::min(outsideUntil, candidate.outsideUntil);
    }
    farUntil = std::min(farUntil, way_ + (outsideUntil - way_) * countedOfWay(pair));
    list.finish();
    const bool turnsWithA = !shapeA.isPlane && shapeA.boundingRadius == smaller;
    reduceContacts(contacts, known, turnsWithA ? worldFromA : worldFromB, smaller);
    apart_ = farUntil - way_ - bulge;
    odometerThen_ = odometer;
}

}  // namespace scree
