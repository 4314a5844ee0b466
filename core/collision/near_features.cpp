#include "core/collision/near_features.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/fetch.h"
#include "core/collision/ball_contacts.h"
#include "core/collision/capsule_contacts.h"
#include "core/collision/capsule_places.h"
#include "core/collision/contact_list.h"
#include "core/collision/contact_reduction.h"
#include "core/collision/convex_overlap.h"
#include "core/collision/corner_contacts.h"
#include "core/collision/crease_contacts.h"
#include "core/collision/deep_contact.h"
#include "core/collision/edge_contacts.h"
#include "core/collision/feature_memory.h"
#include "core/collision/hull_distance.h"

namespace scree {
namespace {

/// The feature that a ball inside is, among the places of round surfaces.
constexpr std::int32_t kInnerBall = std::numeric_limits<std::int32_t>::max();

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

/// The two ways to look at a pair, and what turns what each finds into contacts of it.
struct BothWays {
    Mat3 worldFromA, worldFromB;
    RelativePair pair, back;  // A seen from B, and B seen from A
    ToWorld ofA, ofB;

    explicit BothWays(const PlacedPair& bodies)
        : worldFromA(bodies.worldFromA.orientation.toRotationMatrix()),
          worldFromB(bodies.worldFromB.orientation.toRotationMatrix()),
          pair(relativePair(bodies, worldFromA, worldFromB)),
          back(pair.reversed()),
          ofA{worldFromB, bodies.worldFromB.position - bodies.worldFromA.position, true},
          ofB{worldFromA, Vec3::Zero(), false}
    {
    }
};

/// Whether the one is a capsule or ball, and the other too or a plane.
bool areCapsules(const RelativePair& pair)
{
    const Shape &a = pair.first, &b = pair.second;
    return (a.isCapsule() && (b.isCapsule() || b.isPlane)) || (a.isPlane && b.isCapsule());
}

/// Of such a pair; answers how far they are apart [m].
double addCapsuleContacts(const BothWays& ways, double reach, std::vector<GapContact>& contacts)
{
    const bool isA = ways.pair.first.isCapsule();
    thread_local std::vector<CapsuleContact> found;
    const double apart = findCapsuleContacts(isA ? ways.pair : ways.back, reach, found);
    for (const CapsuleContact& one : found) {
        contacts.push_back((isA ? ways.ofA : ways.ofB)(
            featureId(FeatureKind::round, one.ofFirst, one.ofSecond), one.contact));
    }
    return apart;
}

/// Adds where a ball, or one that ends a capsule, touches.
void addBallContact(const RelativePair& way, const ToWorld& toWorld, std::int32_t part,
                    std::uint64_t feature, const BallContact& ball, ContactList& list)
{
    const auto [one, other] = ball.place;
    const auto add = [&](ContactPart ofSecond) {
        return list.add(way, {Part::ball, part}, ofSecond, toWorld, feature, ball.contact);
    };
    // Where one round part goes over into another, as at the end of the side of a capsule, the
    // triangle may be of the wrong one.
    const bool isFace = other == 0;
    if (add({Part::face}) || isFace) return;
    if (!add({Part::corner, one - 1}) && other != one) add({Part::corner, other - 1});
}

/// Of a pair of which one is a ball.
void addBallContacts(const BothWays& ways, double reach, ContactList& list)
{
    const bool isA = ways.pair.first.isBall();
    const RelativePair& way = isA ? ways.pair : ways.back;
    const Ball ball{way.translation, way.first.capsule.radius};
    thread_local std::vector<BallContact> found;
    findBallContacts(ball, way.second, reach, found);
    for (const BallContact& one : found) {
        const auto [place, other] = one.place;
        addBallContact(way, isA ? ways.ofA : ways.ofB, 0,
                       featureId(FeatureKind::round, place, other), one, list);
    }
}

/// Whether the one is a capsule and the other a mesh.
bool isCapsuleOnMesh(const RelativePair& pair)
{
    const Shape& mesh = pair.first.isCapsule() ? pair.second : pair.first;
    return (pair.first.isCapsule() || pair.second.isCapsule()) && !mesh.distance.solid();
}

/// Of such a pair, the ones of the facets aside; answers how far the two are apart, or nothing
/// where those must tell [m].
std::optional<double> addCapsulePlaces(const BothWays& ways, double reach, ContactList& list)
{
    const bool isA = ways.pair.first.isCapsule();
    const RelativePair& way = isA ? ways.pair : ways.back;
    const ToWorld& toWorld = isA ? ways.ofA : ways.ofB;
    thread_local CapsulePlaces found;
    const std::optional<double> apart = findCapsulePlaces(way, reach, found);
    if (!apart) return {};
    const auto featureAt = [](int part, const std::array<std::int32_t, 2>& place) {
        return featureId(FeatureKind::round, 3 * place[0] + part, place[1]);
    };
    for (const int part : {1, 2}) {
        for (const BallContact& one : found.ofEnd[part - 1])
            addBallContact(way, toWorld, part, featureAt(part, one.place), one, list);
    }
    for (const CapsulePlace& one : found.between)
        list.add(way, {Part::ball, 0}, one.ofMesh, toWorld, featureAt(0, one.place), one.contact);
    return apart;
}

GapContact inWorld(const BothWays& ways, const DeepContact& deep)
{
    const std::uint64_t feature = featureId(FeatureKind::round, kInnerBall, deep.isOfFirst ? 0 : 1);
    return (deep.isOfFirst ? ways.ofA : ways.ofB)(feature, deep.contact);
}

/// Adds what a corner of the first touches: a face, or both sides of a crease.
void addCorner(const RelativePair& pair, FeatureKind kind, const ToWorld& toWorld, double reach,
               std::int32_t corner, const FacedCorner& faced, ContactList& list)
{
    const auto add = [&](const FeatureContact& contact, std::int32_t side) {
        list.add(pair, {Part::corner, corner}, {Part::face}, toWorld, featureId(kind, corner, side),
                 contact);
    };
    thread_local std::vector<CreaseContact> creased;
    creased.clear();
    // What might be as far away as `reach` is not asked about every time.
    if (faced.within < reach) findCreaseContacts(pair, corner, reach, faced.contact, creased);
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

/// Adds what the corners of the first touch.
void faceCorners(const RelativePair& pair, FeatureKind kind, const ToWorld& toWorld, double reach,
                 FeatureMemory& memory, ContactList& list)
{
    const double sharpness = sharpnessOf(pair);
    memory.visitCorners(kind, reach, [&](std::int32_t corner) {
        const FacedCorner faced = faceCorner(pair, corner, reach, sharpness);
        addCorner(pair, kind, toWorld, reach, corner, faced, list);
        // What touches is asked about every time: it may be anywhere inside.
        const bool touches = faced.contact || faced.unsupported;
        return touches ? -std::numeric_limits<double>::infinity() : faced.apart;
    });
}

/// Adds where edges touch; `isNew` right after a look.
void touchEdges(const RelativePair& pair, const ToWorld& toWorld, double reach, bool isNew,
                FeatureMemory& memory, ContactList& list)
{
    const double sharpness = sharpnessOf(pair);
    thread_local std::vector<EdgePair> mayTouch;
    thread_local std::vector<std::pair<EdgePair, FeatureContact>> passing;
    memory.findEdges(pair, reach, isNew, mayTouch);
    passing.clear();
    for (const auto& [ofA, ofB] : mayTouch) {
        const FacedEdges faced = faceEdges(pair, ofA, ofB, reach, sharpness);
        if (faced.contact) {
            list.add(pair, {Part::edge, ofA}, {Part::edge, ofB}, toWorld,
                     featureId(FeatureKind::edges, ofA, ofB), *faced.contact);
        } else if (faced.passing) {
            passing.push_back({{ofA, ofB}, *faced.passing});
        }
    }
    // How deep edges lie is dear to find, and most of them are not heard in the end: of a thousand
    // rings where they are most crowded 8 of 258 000.
    for (const auto& [edges, lines] : passing) {
        const auto [ofA, ofB] = edges;
        const auto touched = touchInPassing(pair, ofA, ofB, lines, reach, list.heardBelow());
        if (touched)
            list.addUnsupported(toWorld(featureId(FeatureKind::edges, ofA, ofB), *touched));
    }
}

/// Corners past the middle of a plate lead out on its far side: with these a cube that had been
/// pressed half into a keyed plate hung in it for ever.
void dropContrary(const Vec3& out, std::vector<GapContact>& contacts, std::size_t first)
{
    const auto begin = contacts.begin() + static_cast<std::ptrdiff_t>(first);
    contacts.erase(std::remove_if(begin, contacts.end(),
                                  [&](const GapContact& one) { return one.normal.dot(out) < 0.0; }),
                   contacts.end());
}

/// Adds the shortest way out of each other of two convex bodies that have been pressed into each
/// other, where the contacts tell far less. What hardly overlaps by these is not asked.
void addUntold(const BothWays& ways, double smaller, std::vector<GapContact>& contacts,
               std::size_t first)
{
    constexpr double kAsked = 5e-3;  // from this share of the smaller body on
    constexpr double kTold = 0.5;    // of what there is
    const ContactFeatures &ofA = ways.pair.first.features, &ofB = ways.pair.second.features;
    if (!ofA.isConvex() || !ofB.isConvex()) return;
    double told = 0.0;
    for (std::size_t i = first; i < contacts.size(); ++i) told = std::min(told, contacts[i].gap);
    if (told > -kAsked * smaller) return;
    const std::optional<FeatureContact> out = overlapOfConvex(ways.pair);
    if (!out || told < kTold * out->gap) return;
    const GapContact contact = ways.ofA(featureId(FeatureKind::round, kInnerBall, 2), *out);
    dropContrary(contact.normal, contacts, first);
    contacts.push_back(contact);
}

/// How far a pair without contacts is apart, of which its features tell `far` [m]. They tell little
/// of what they cannot rule out to come near: of a building that falls to pieces three in four
/// pairs were asked about in every step for nothing. Not worth while for what is not asked again
/// soon.
double farByHulls(const RelativePair& pair, double reach, double far)
{
    constexpr double kSoon = 3.0;  // times the reach
    return far < kSoon * reach && areHullsSmall(pair) ? std::max(far, hullsApart(pair)) : far;
}

}  // namespace

double apartAtLeast(const PlacedPair& bodies)
{
    const BothWays ways(bodies);
    const RelativePair &pair = ways.pair, &back = ways.back;
    const auto ofBall = [](const RelativePair& way) {
        return way.second.distance.lowerBound(way.translation) - way.first.boundingRadius;
    };
    const double apart = pair.first.isBall()    ? ofBall(pair)
                         : pair.second.isBall() ? ofBall(back)
                                                : apartAtLeast(pair, back);
    return apart - bulgeOf(pair);
}

NearFeatures::NearFeatures() = default;
NearFeatures::~NearFeatures() = default;
NearFeatures::NearFeatures(NearFeatures&&) noexcept = default;
NearFeatures& NearFeatures::operator=(NearFeatures&&) noexcept = default;

double NearFeatures::findContacts(const PlacedPair& bodies, double reach,
                                  std::vector<GapContact>& contacts)
{
    const Shape &shapeA = *bodies.shapeA, &shapeB = *bodies.shapeB;
    const BothWays ways(bodies);
    const RelativePair &pair = ways.pair, &back = ways.back;
    if (areCapsules(pair)) return addCapsuleContacts(ways, reach, contacts);
    const double smaller = smallerRadius(shapeA, shapeB);
    const double bulge = bulgeOf(pair);
    const std::size_t known = contacts.size();
    const double thickness = std::min(shapeA.commonThickness, shapeB.commonThickness);
    ContactList list(contacts, smaller, thickness, reach, bulge);
    reach += bulge;

    if (shapeA.isBall() || shapeB.isBall()) {
        addBallContacts(ways, reach, list);
        list.finish();
        return 0.0;
    }
    if (isCapsuleOnMesh(pair)) {
        if (const auto apart = addCapsulePlaces(ways, reach, list)) {
            list.finish();
            return *apart - bulge;
        }
    }

    const std::optional<DeepContact> deep = findDeepContact(pair, back);
    if (deep) contacts.push_back(inWorld(ways, *deep));
    if (deep && deep->speaksAlone) return deep->contact.gap;
    const double least = deep ? deep->contact.gap : std::numeric_limits<double>::infinity();
    const Vec3 out = deep ? contacts.back().normal : Vec3(Vec3::Zero());
    // Features can be far while one body lies well inside the other: then its ball may be next.
    const auto farAt = [&](double apart) {
        const double far = std::min(least, apart - bulge);
        return far > 0.0 ? wayToDeepContact(pair, back, far) : far;
    };

    const bool isNew = !memory_ || memory_->isStaleAt(pair, reach);
    if (isNew) {
        const double apart = look(pair, back, reach);
        if (!memory_) return farAt(apart);
    }

    // In an order of the shapes: of places that say the same the first one gives its id.
    faceCorners(pair, FeatureKind::cornerOfA, ways.ofA, reach, *memory_, list);
    faceCorners(back, FeatureKind::cornerOfB, ways.ofB, reach, *memory_, list);
    touchEdges(pair, ways.ofA, reach, isNew, *memory_, list);
    list.finish();
    if (deep) dropContrary(out, contacts, known);
    addUntold(ways, smaller, contacts, known);
    const bool turnsWithA = !shapeA.isPlane && shapeA.boundingRadius == smaller;
    reduceContacts(contacts, known, turnsWithA ? ways.worldFromA : ways.worldFromB, smaller);
    const double far = memory_->farFor(pair);
    return farAt(contacts.size() > known ? far : farByHulls(pair, reach, far));
}

double NearFeatures::look(const RelativePair& pair, const RelativePair& back, double reach)
{
    const double pace = memory_ ? memory_->pace() : std::numeric_limits<double>::infinity();
    const double window = lookAhead(pair, reach, pace);
    const double far = reach + window;
    // Most pairs whose boxes meet are far apart: a few spheres say how far.
    if (!memory_) {
        const double apart = apartAtLeast(pair, back);
        if (apart > far) return apart;
    }
    // So are most of the others that are looked at for the first time.
    thread_local FeatureMemory seen;
    const double apart = seen.look(pair, back, reach, window);
    if (apart > far)
        memory_.reset();
    else if (memory_)
        *memory_ = seen;
    else
        memory_ = std::make_unique<FeatureMemory>(seen);
    return apart;
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
