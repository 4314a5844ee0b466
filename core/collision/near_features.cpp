#include "core/collision/near_features.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/fetch.h"
#include "core/collision/ball_contacts.h"
#include "core/collision/contact_list.h"
#include "core/collision/contact_reduction.h"
#include "core/collision/corner_contacts.h"
#include "core/collision/crease_contacts.h"
#include "core/collision/deep_contact.h"
#include "core/collision/edge_contacts.h"
#include "core/collision/edge_lanes.h"
#include "core/geometry/distance_lanes.h"

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 0.3;        // times the reach
constexpr double kLeastLookAhead = 0.03;  // times the bounding radius of the smaller body

/// The feature that a ball inside is, among the places of round surfaces.
constexpr std::int32_t kInnerBall = std::numeric_limits<std::int32_t>::max();

constexpr double kFarAway = 1e15;  // [m]; its square is a float

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
    return pair.first.bulge() + pair.second.bulge();
}

/// Lower bound of the distance between what the spheres hold and the field.
double apartAtLeast(const DistanceLanes& field, const std::vector<SphereLanes>& cover)
{
    FloatLanes atLeast = floatLanesOf(std::numeric_limits<float>::infinity());
    for (const SphereLanes& spheres : cover) atLeast = minOf(atLeast, field.apartAtLeast(spheres));
    return leastOf(atLeast);
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

/// Calls leaf(thing, distance) for all of a tree that may come within `clearance` of the field, in
/// the order of the tree, where what is near each other is next to each other; with a lower bound
/// of its distance. Answers one of all the others [m].
template <class Leaf>
float findNear(const SphereLaneTree& tree, const DistanceLanes& field, double clearance,
               const Leaf& leaf)
{
    const FloatLanes within = floatLanesOf(clearance);
    const FloatLanes never = floatLanesOf(std::numeric_limits<float>::infinity());
    FloatLanes apart = never, atLeast = never;
    tree.visit(
        [&](const SphereLanes& spheres) {
            atLeast = field.apartAtLeast(spheres);
            const IntLanes isNear = atLeast < within;
            apart = minOf(apart, isNear ? never : atLeast);
            return bitsOf(isNear);
        },
        [&](std::uint32_t thing, int lane) { leaf(thing, atLeast[lane]); });
    return leastOf(apart);
}

/// Edges of the first shape.
float findEdgesNear(const RelativePair& pair, double clearance, std::vector<std::int32_t>& near)
{
    near.clear();
    return findNear(pair.first.features.edgeTree(), fieldOfSecond(pair), clearance,
                    [&](std::uint32_t e, float) { near.push_back(static_cast<std::int32_t>(e)); });
}

/// Lanes that are left over repeat the last edge.
void inEights(const std::vector<EdgeLine>& lines, const std::vector<std::int32_t>& chosen,
              std::vector<FacingLanes>& eights)
{
    eights.clear();
    for (std::size_t first = 0; first < chosen.size(); first += kFloatLanes) {
        EightEdges edges;
        for (std::size_t i = 0; i < edges.size(); ++i)
            edges[i] = &lines[chosen[std::min(first + i, chosen.size() - 1)]];
        eights.emplace_back(edges);
    }
}

/// A sphere around each eight, eight of these side by side; lanes that are left over hold nothing.
void inSpheres(const std::vector<FacingLanes>& eights, std::vector<SphereLanes>& spheres)
{
    spheres.assign((eights.size() + kFloatLanes - 1) / kFloatLanes, {{}, floatLanesOf(-kFarAway)});
    for (std::size_t i = 0; i < eights.size(); ++i) {
        const Sphere around = eights[i].around();
        SphereLanes& eight = spheres[i / kFloatLanes];
        const int lane = static_cast<int>(i % kFloatLanes);
        eight.centre.set(lane, around.centre);
        eight.radius[lane] = static_cast<float>(around.radius);
    }
}

/// Those eights with anything within `farthest` of an edge: of two bones three in ten.
void findEightsNear(const FacingLanes& edge, const std::vector<SphereLanes>& spheres,
                    double farthest, std::vector<std::size_t>& near)
{
    near.clear();
    const FloatLanes reach = edge.half + floatLanesOf(farthest);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const FloatLanes3 way = spheres[i].centre - edge.middle;
        const FloatLanes most = reach + spheres[i].radius;
        unsigned bits = bitsOf((dot(way, way) <= most * most) & (most > 0.0f));
        for (; bits; bits &= bits - 1)
            near.push_back(kFloatLanes * i + static_cast<std::size_t>(std::countr_zero(bits)));
    }
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

/// In single precision, and then some: what is remembered must not be more than was seen.
float roundedDown(double x)
{
    return static_cast<float>(x - kSinglePrecision * std::abs(x));
}
double roundedUp(double x)
{
    return x + kSinglePrecision * std::abs(x);
}

/// Of places of the first body in the frame of the second, told in single precision [m].
double roundingOf(const RelativePair& pair)
{
    return kSinglePrecision * (pair.first.boundingRadius + pair.translation.norm());
}

/// How far beyond its reach a look sees [m].
double lookAhead(const RelativePair& pair, double reach)
{
    return std::max(kLookAhead * reach, kLeastLookAhead * smallerRadius(pair.first, pair.second));
}

/// The next free lane of eights that are filled one lane after the other.
template <class Eight>
std::pair<Eight&, std::size_t> nextLane(std::vector<Eight>& eights, std::size_t& filled)
{
    const std::size_t lane = filled++ % kFloatLanes;
    if (lane == 0) eights.emplace_back();
    return {eights.back(), lane};
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

/// Distances change no faster than points move. So for every feature there is a place on the way of
/// the pair (how far any point has moved in the frame of the other body, added up) before which it
/// need not be looked at; and for most pairs one for all of them.
class alignas(64) NearFeatures::Memory {
public:
    /// Follows the pair; answers whether it has to be looked at again.
    bool isStaleAt(const RelativePair& pair, double reach);

    /// Looks at all features; answers how far apart the bodies are at least [m]. What is nearer
    /// than that is noted.
    double look(const RelativePair& pair, const RelativePair& back, double reach);

    /// Adds all contacts below `reach`; `isNew` right after a look.
    void addContacts(const RelativePair& pair, const RelativePair& back, const ToWorld& ofA,
                     const ToWorld& ofB, double reach, bool isNew, ContactList& list);

    /// How much longer a way there is, in the world, before there may be others [m].
    double farFor(const RelativePair& pair) const;

    void prefetchLists() const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr FloatLanes kNever = {kInfinity, kInfinity, kInfinity, kInfinity,
                                          kInfinity, kInfinity, kInfinity, kInfinity};

    /// What is told eight at a time, in single precision, on the way since the last look [m]. Lanes
    /// that are left over are infinitely far.
    struct alignas(64) NearCorners {
        FloatLanes farUntil = kNever;  // how far they were when last looked at
        std::array<std::int32_t, kFloatLanes> corner = {};
    };
    struct alignas(64) NearEdges {
        FloatLanes farUntil = kNever;
        FloatLanes outsideUntil = kNever;  // the way until which they cannot have crossed
        std::array<std::int32_t, kFloatLanes> ofA = {}, ofB = {};
    };
    /// Each answers how far all of its features are at least, if none is near, and otherwise the
    /// clearance [m].
    double lookAtCorners(const RelativePair& pair, std::vector<NearCorners>& near) const;
    double lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach,
                       std::vector<NearEdges>& found) const;
    void faceCorners(const RelativePair& pair, FeatureKind kind, const ToWorld& toWorld,
                     double reach, std::vector<NearCorners>& near, ContactList& list) const;
    void touchEdges(const RelativePair& pair, const ToWorld& toWorld, double reach,
                    std::vector<NearEdges>& near, ContactList& list) const;
    void keep(const std::vector<NearEdges>& found, double reach);

    /// What the last look of this thread has found, before it is known what of that to keep.
    static std::vector<NearEdges>& foundEdges()
    {
        thread_local std::vector<NearEdges> found;
        return found;
    }

    double moved_ = 0.0;                // the way since the last look [m]
    double window_ = 0.0;               // for which that is good [m]
    double clearance_ = 0.0;            // everything nearer was noted then [m]
    Mat3 rotation_ = Mat3::Identity();  // B from A, when last asked about
    Vec3 translation_ = Vec3::Zero();
    std::vector<NearCorners> cornersOfA_, cornersOfB_;
    std::vector<NearEdges> edges_;
};

bool NearFeatures::Memory::isStaleAt(const RelativePair& pair, double reach)
{
    // The norm of what two rotations differ by is √2 times the chord of a point at unit distance.
    const double chord = (pair.rotation - rotation_).norm() / std::numbers::sqrt2;
    moved_ += (pair.translation - translation_).norm() + chord * leverOf(pair);
    rotation_ = pair.rotation;
    translation_ = pair.translation;
    return moved_ > window_ || reach + moved_ > clearance_;
}

double NearFeatures::Memory::lookAtCorners(const RelativePair& pair,
                                           std::vector<NearCorners>& near) const
{
    thread_local std::vector<NearCorners> found;
    found.clear();
    const ContactFeatures& features = pair.first.features;
    std::size_t count = 0;
    const double apart = findNear(features.cornerTree(), fieldOfSecond(pair), clearance_,
                                  [&](std::uint32_t i, float atLeast) {
                                      auto [eight, free] = nextLane(found, count);
                                      eight.farUntil[free] = atLeast;
                                      eight.corner[free] = features.corners()[i];
                                  });
    near.assign(found.begin(), found.end());
    return found.empty() ? apart : clearance_;
}

double NearFeatures::Memory::lookAtEdges(const RelativePair& pair, const RelativePair& back,
                                         double reach, std::vector<NearEdges>& found) const
{
    found.clear();
    const ContactFeatures &first = pair.first.features, &second = pair.second.features;
    if (first.edges().empty() || second.edges().empty()) return kInfinity;
    thread_local std::vector<std::int32_t> nearA, nearB;
    thread_local std::vector<FacingLanes> eightsOfA, eightsOfB;
    const double apartA = findEdgesNear(pair, clearance_, nearA);
    if (nearA.empty()) return apartA;
    const double apartB = findEdgesNear(back, clearance_, nearB);
    if (nearB.empty()) return apartB;
    inEights(first.lines(), nearA, eightsOfA);
    inEights(second.lines(), nearB, eightsOfB);

    const double farthest = std::max(reach, deepestEdges(pair)) + window_ + roundingOf(pair);
    const double turn = window_ / leverOf(pair) + kSinglePrecision;
    for (FacingLanes& eight : eightsOfA) eight = eight.placed(pair.rotation, pair.translation);
    thread_local std::vector<SphereLanes> spheresOfB;
    thread_local std::vector<std::size_t> nearEights;
    inSpheres(eightsOfB, spheresOfB);
    std::size_t count = 0;
    for (std::size_t a = 0; a < nearA.size(); ++a) {
        const FacingLanes edge = eightsOfA[a / kFloatLanes].all(static_cast<int>(a % kFloatLanes));
        findEightsNear(edge, spheresOfB, farthest, nearEights);
        for (const std::size_t eight : nearEights) {
            unsigned bits = mayFace(edge, eightsOfB[eight], farthest, turn);
            for (; bits; bits &= bits - 1) {
                const std::size_t b =
                    kFloatLanes * eight + static_cast<std::size_t>(std::countr_zero(bits));
                if (b >= nearB.size()) break;
                auto [edges, free] = nextLane(found, count);
                edges.farUntil[free] = edges.outsideUntil[free] = 0.0f;
                edges.ofA[free] = nearA[a];
                edges.ofB[free] = nearB[b];
            }
        }
    }
    return clearance_;
}

double NearFeatures::Memory::look(const RelativePair& pair, const RelativePair& back, double reach)
{
    moved_ = 0.0;
    rotation_ = pair.rotation;
    translation_ = pair.translation;
    window_ = lookAhead(pair, reach);
    clearance_ = reach + window_;
    return std::min({lookAtCorners(pair, cornersOfA_), lookAtCorners(back, cornersOfB_),
                     lookAtEdges(pair, back, reach, foundEdges())});
}

void NearFeatures::Memory::faceCorners(const RelativePair& pair, FeatureKind kind,
                                       const ToWorld& toWorld, double reach,
                                       std::vector<NearCorners>& near, ContactList& list) const
{
    const double sharpness = kSharpness * smallerRadius(pair.first, pair.second);
    const FloatLanes needed = floatLanesOf(roundedUp(reach + moved_));
    thread_local std::vector<CreaseContact> creased;
    for (NearCorners& eight : near) {
        for (unsigned bits = bitsOf(eight.farUntil < needed); bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            const std::int32_t corner = eight.corner[lane];
            const FacedCorner faced = faceCorner(pair, corner, reach, sharpness);
            eight.farUntil[lane] = roundedDown(moved_ + faced.apart);
            const auto add = [&](const FeatureContact& contact, std::int32_t side) {
                list.add(pair, {Part::corner, corner}, {Part::face}, toWorld,
                         featureId(kind, corner, side), contact);
            };
            creased.clear();
            // What might be as far away as `reach` is not asked about every time.
            if (faced.within < reach)
                findCreaseContacts(pair, corner, reach, faced.contact, creased);
            bool isTold = false;
            for (const auto& [contact, side] : creased) {
                add(contact, 1 + side);
                isTold = isTold || (faced.contact && contact.normal == faced.contact->normal);
            }
            if (faced.contact) {
                if (!isTold) add(*faced.contact, 0);
            } else if (faced.unsupported) {
                list.addUnsupported(toWorld(featureId(kind, corner), *faced.unsupported));
            }
        }
    }
}

void NearFeatures::Memory::touchEdges(const RelativePair& pair, const ToWorld& toWorld,
                                      double reach, std::vector<NearEdges>& near,
                                      ContactList& list) const
{
    if (near.empty()) return;
    const double deepest = deepestEdges(pair);
    const double sharpness = kSharpness * smallerRadius(pair.first, pair.second);
    const double rounding = roundingOf(pair) + kSinglePrecision * pair.second.boundingRadius;
    const std::vector<EdgeLine>& first = pair.first.features.lines();
    const std::vector<EdgeLine>& second = pair.second.features.lines();
    const RotationLanes rotation(pair.rotation);
    const FloatLanes3 translation = FloatLanes3::all(pair.translation);
    const FloatLanes moved = floatLanesOf(roundedDown(moved_));
    EightEdges ofFirst, ofSecond;
    std::array<std::pair<NearEdges*, int>, kFloatLanes> asked;
    std::size_t filled = 0;
    const auto flush = [&] {
        for (std::size_t idle = filled; idle < kFloatLanes; ++idle) {
            ofFirst[idle] = ofFirst[0];
            ofSecond[idle] = ofSecond[0];
        }
        LineLanes a(ofFirst);
        a.place(rotation, translation);
        const EdgeGaps gaps = edgeGaps(a, LineLanes(ofSecond), deepest, reach, rounding);
        const FloatLanes farUntil = moved + gaps.distance, outsideUntil = moved + gaps.outside;
        const unsigned mayTouch = bitsOf(gaps.mayTouch);
        for (std::size_t i = 0; i < filled; ++i) {
            const auto [eight, lane] = asked[i];
            eight->farUntil[lane] = farUntil[i];
            eight->outsideUntil[lane] = outsideUntil[i];
            if (!(mayTouch >> i & 1u)) continue;
            const std::int32_t ofA = eight->ofA[lane], ofB = eight->ofB[lane];
            const FacedEdges faced = faceEdges(pair, ofA, ofB, reach, sharpness);
            const std::uint64_t feature = featureId(FeatureKind::edges, ofA, ofB);
            if (faced.contact) {
                list.add(pair, {Part::edge, ofA}, {Part::edge, ofB}, toWorld, feature,
                         *faced.contact);
            } else if (faced.unsupported) {
                list.addUnsupported(toWorld(feature, *faced.unsupported));
            }
        }
        filled = 0;
    };
    const FloatLanes needed = floatLanesOf(roundedUp(reach + moved_));
    const FloatLanes hasMoved = floatLanesOf(roundedUp(moved_));
    for (NearEdges& eight : near) {
        unsigned bits = bitsOf((eight.farUntil < needed) | (eight.outsideUntil <= hasMoved));
        for (; bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            ofFirst[filled] = &first[eight.ofA[lane]];
            ofSecond[filled] = &second[eight.ofB[lane]];
            asked[filled++] = {&eight, lane};
            if (filled == kFloatLanes) flush();
        }
    }
    if (filled > 0) flush();
}

/// Of the pairs of edges found those that may matter before the next look.
void NearFeatures::Memory::keep(const std::vector<NearEdges>& found, double reach)
{
    thread_local std::vector<NearEdges> kept;
    kept.clear();
    const FloatLanes needed = floatLanesOf(roundedUp(reach + window_));
    const FloatLanes window = floatLanesOf(roundedUp(window_));
    std::size_t count = 0;
    for (const NearEdges& eight : found) {
        unsigned bits = bitsOf((eight.farUntil < needed) | (eight.outsideUntil <= window));
        for (; bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            auto [keeping, free] = nextLane(kept, count);
            keeping.farUntil[free] = eight.farUntil[lane];
            keeping.outsideUntil[free] = eight.outsideUntil[lane];
            keeping.ofA[free] = eight.ofA[lane];
            keeping.ofB[free] = eight.ofB[lane];
        }
    }
    edges_.assign(kept.begin(), kept.end());
}

void NearFeatures::Memory::addContacts(const RelativePair& pair, const RelativePair& back,
                                       const ToWorld& ofA, const ToWorld& ofB, double reach,
                                       bool isNew, ContactList& list)
{
    std::vector<NearEdges>& found = foundEdges();
    faceCorners(pair, FeatureKind::cornerOfA, ofA, reach, cornersOfA_, list);
    faceCorners(back, FeatureKind::cornerOfB, ofB, reach, cornersOfB_, list);
    touchEdges(pair, ofA, reach, isNew ? found : edges_, list);
    if (isNew) keep(found, reach);
}

double NearFeatures::Memory::farFor(const RelativePair& pair) const
{
    FloatLanes farUntil = kNever, outsideUntil = kNever;
    for (const std::vector<NearCorners>* near : {&cornersOfA_, &cornersOfB_}) {
        for (const NearCorners& eight : *near) farUntil = minOf(farUntil, eight.farUntil);
    }
    for (const NearEdges& eight : edges_) {
        farUntil = minOf(farUntil, eight.farUntil);
        outsideUntil = minOf(outsideUntil, eight.outsideUntil);
    }
    const double far = std::min({clearance_, window_, double{leastOf(farUntil)}}) - moved_;
    const double outside = (leastOf(outsideUntil) - moved_) * countedOfWay(pair);
    return std::min(far, outside);
}

void NearFeatures::Memory::prefetchLists() const
{
    fetchItems(cornersOfA_);
    fetchItems(cornersOfB_);
    fetchItems(edges_);
}

namespace {

/// Corners past the middle of a plate lead out on its far side: with these a cube that had been
/// pressed half into a keyed plate hung in it for ever.
void dropContrary(const Vec3& out, std::vector<GapContact>& contacts, std::size_t first)
{
    const auto begin = contacts.begin() + static_cast<std::ptrdiff_t>(first);
    contacts.erase(std::remove_if(begin, contacts.end(),
                                  [&](const GapContact& one) { return one.normal.dot(out) < 0.0; }),
                   contacts.end());
}

}  // namespace

NearFeatures::NearFeatures() = default;
NearFeatures::~NearFeatures() = default;
NearFeatures::NearFeatures(NearFeatures&&) noexcept = default;
NearFeatures& NearFeatures::operator=(NearFeatures&&) noexcept = default;

double NearFeatures::findContacts(const PlacedPair& bodies, double reach,
                                  std::vector<GapContact>& contacts)
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
        return 0.0;
    }

    const std::optional<DeepContact> deep = findDeepContact(pair, back);
    Vec3 out = Vec3::Zero();  // of what is deep
    if (deep) {
        const std::uint64_t feature =
            featureId(FeatureKind::round, kInnerBall, deep->isOfFirst ? 0 : 1);
        contacts.push_back((deep->isOfFirst ? ofA : ofB)(feature, deep->contact));
        if (deep->speaksAlone) return deep->contact.gap;
        out = contacts.back().normal;
    }
    const double least = deep ? deep->contact.gap : std::numeric_limits<double>::infinity();
    const bool isNew = !memory_ || memory_->isStaleAt(pair, reach);
    const double far = reach + lookAhead(pair, reach);
    if (!memory_) {
        // Most pairs whose boxes meet are far apart: a few spheres say how far.
        const double apart = apartAtLeast(pair, back);
        if (apart > far) return std::min(least, apart - bulge);
        memory_ = std::make_unique<Memory>();
    }
    if (isNew) {
        const double apart = memory_->look(pair, back, reach);
        if (apart > far) {
            memory_.reset();
            return std::min(least, apart - bulge);
        }
    }
    memory_->addContacts(pair, back, ofA, ofB, reach, isNew, list);
    list.finish();
    if (deep) dropContrary(out, contacts, known);
    const bool turnsWithA = !shapeA.isPlane && shapeA.boundingRadius == smaller;
    reduceContacts(contacts, known, turnsWithA ? worldFromA : worldFromB, smaller);
    return std::min(least, memory_->farFor(pair) - bulge);
}

void NearFeatures::prefetch() const
{
    if (memory_) fetchLines(memory_.get(), memory_.get() + 1);
}

void NearFeatures::prefetchLists() const
{
    if (memory_) memory_->prefetchLists();
}

}  // namespace scree
