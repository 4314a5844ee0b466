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

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 1.0;        // times the reach
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

double apartAtLeast(const RelativePair& pair, const RelativePair& back)
{
    return std::min({apartAtLeast(pair, pair.first.features.cornerTree()),
                     apartAtLeast(back, back.first.features.cornerTree()),
                     back.first.features.edges().empty()
                         ? std::numeric_limits<double>::infinity()
                         : apartAtLeast(pair, pair.first.features.edgeTree())});
}

/// An edge of the first shape in the frame of the second, all but its face normals.
ConvexEdge placed(const RelativePair& pair, const ConvexEdge& edge)
{
    ConvexEdge moved = edge;
    moved.start = pair * edge.start;
    moved.direction = pair.rotation * edge.direction;
    moved.outward = pair.rotation * edge.outward;
    for (Vec3& intoFace : moved.intoFace) intoFace = pair.rotation * intoFace;
    return moved;
}

void setFacing(FacingLanes& four, int lane, const ConvexEdge& edge)
{
    four.edge.set(lane, edge);
    for (int k : {0, 1}) four.intoFace[k].set(lane, edge.intoFace[k]);
}

/// Edges of the second shape, four abreast, and a few fours at a time in a sphere: of a fine mesh
/// most are far from any one edge of the first. Lanes that are left over are nowhere.
struct NearLanes {
    static constexpr std::size_t kTogether = 4 * kLanes;  // edges in a sphere
    std::vector<FacingLanes> fours;
    std::vector<Sphere> spheres;

    void fill(const ContactFeatures& features, const std::vector<std::int32_t>& chosen)
    {
        constexpr double kNowhere = 1e100;
        fours.resize((chosen.size() + kLanes - 1) / kLanes);
        for (std::size_t i = 0; i < fours.size() * kLanes; ++i) {
            FacingLanes& four = fours[i / kLanes];
            const int lane = static_cast<int>(i % kLanes);
            if (i < chosen.size()) {
                setFacing(four, lane, features.edges()[chosen[i]]);
            } else {
                four.edge.start.set(lane, Vec3::Constant(kNowhere));
            }
        }
        spheres.clear();
        for (std::size_t begin = 0; begin < chosen.size(); begin += kTogether) {
            Aabb box;
            for (std::size_t i = begin; i < std::min(begin + kTogether, chosen.size()); ++i) {
                const ConvexEdge& edge = features.edges()[chosen[i]];
                box.include(edge.start);
                box.include(edge.start + edge.length * edge.direction);
            }
            spheres.push_back({box.centre(), 0.5 * box.size().norm()});
        }
    }

    /// Calls work(four) for all that may be nearer to the edge, placed among them, than `farthest`.
    template <class Work>
    void visitNear(const ConvexEdge& edge, double farthest, const Work& work) const
    {
        const double half = 0.5 * edge.length;
        const Vec3 middle = edge.start + half * edge.direction;
        constexpr std::size_t kFours = kTogether / kLanes;
        for (std::size_t s = 0; s < spheres.size(); ++s) {
            const double far = spheres[s].radius + half + farthest;
            if ((spheres[s].centre - middle).squaredNorm() > far * far) continue;
            const std::size_t end = std::min((s + 1) * kFours, fours.size());
            for (std::size_t four = s * kFours; four < end; ++four) work(four);
        }
    }
};

FacingLanes inAllLanes(const ConvexEdge& edge)
{
    return {EdgeLanes::all(edge), {Lanes3::all(edge.intoFace[0]), Lanes3::all(edge.intoFace[1])}};
}

/// Edges of the first shape that may come within `clearance` of the second, in the order of their
/// tree, where what is near each other is next to each other.
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
    const SignedDistance& field = pair.second.distance;
    const auto isClear = [&](const Vec3& centre, double radius) {
        return field.isClearOf(pair * centre, radius + clearance);
    };
    features.cornerTree().visit(isClear, [&](std::uint32_t i) {
        const std::int32_t corner = features.corners()[i];
        const double atLeast = field.lowerBound(pair * features.points().col(corner));
        if (atLeast < clearance) near.push_back({way_ + atLeast, corner});
    });
}

void NearFeatures::lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach)
{
    if (pair.first.features.edges().empty() || pair.second.features.edges().empty()) return;
    thread_local std::vector<std::int32_t> nearA, nearB;
    thread_local NearLanes ofB;
    findEdgesNear(pair, clearance_, nearA);
    if (nearA.empty()) return;
    findEdgesNear(back, clearance_, nearB);
    ofB.fill(pair.second.features, nearB);
    const double deepest = deepestEdges(pair), end = way_ + window_;
    const double farthest = std::max(reach, deepest) + window_;
    const double turn = window_ / leverOf(pair);
    for (std::int32_t e : nearA) {
        const ConvexEdge edge = placed(pair, pair.first.features.edges()[e]);
        const FacingLanes ofA = inAllLanes(edge);
        ofB.visitNear(edge, farthest, [&](std::size_t four) {
            unsigned bits = mayFace(ofA, ofB.fours[four], farthest, turn);
            if (!bits) return;
            const EdgeGaps gaps = edgeGaps(ofA.edge, ofB.fours[four].edge, deepest, reach);
            for (; bits; bits &= bits - 1) {
                const int lane = std::countr_zero(bits);
                const NearEdges edges{way_ + gaps.distance[lane], way_ + gaps.outside[lane], e,
                                      nearB[four * kLanes + static_cast<std::size_t>(lane)]};
                if (edges.farUntil - end < reach || edges.outsideUntil <= end)
                    edges_.push_back(edges);
            }
        });
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
    const double deepest = deepestEdges(pair);
    const double sharpness = kSharpness * smallerRadius(pair.first, pair.second);
    const std::vector<ConvexEdge>& first = pair.first.features.edges();
    const std::vector<ConvexEdge>& second = pair.second.features.edges();
    EdgeLanes ofFirst, ofSecond;
    NearEdges* four[kLanes];
    int filled = 0;
    const auto flush = [&] {
        const EdgeGaps gaps = edgeGaps(ofFirst, ofSecond, deepest, reach);
        const unsigned mayTouch = bitsOf(gaps.mayTouch);
        for (int lane = 0; lane < filled; ++lane) {
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
        const ConvexEdge& edge = first[edges.ofA];
        ofFirst.start.set(filled, pair * edge.start);
        ofFirst.direction.set(filled, pair.rotation * edge.direction);
        ofFirst.length[filled] = edge.length;
        ofSecond.set(filled, second[edges.ofB]);
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
    touchEdges(pair, ofA, reach, list);
    for (const NearEdges& candidate : edges_) {
        const double outside = (candidate.outsideUntil - way_) * countedOfWay(pair);
        farUntil = std::min({farUntil, candidate.farUntil, way_ + outside});
    }
    list.finish();
    const bool turnsWithA = !shapeA.isPlane && shapeA.boundingRadius == smaller;
    reduceContacts(contacts, known, turnsWithA ? worldFromA : worldFromB, smaller);
    apart_ = farUntil - way_ - bulge;
    odometerThen_ = odometer;
}

}  // namespace scree
