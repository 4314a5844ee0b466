// Symbols: u normal velocity (approaching < 0), t time since the step began.
#include "core/dynamics/gaps/pair_foresight.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/body_pairs.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// How far after a blow bodies are looked at, as a share of the smaller one, of what is thin in
/// either, and of the ball inside: edges that are in by half of that are none that touch
/// (deepestEdges). And the share by which they must have gone in.
constexpr double kAfter = 5e-3, kOfThickness = 0.25, kOfInnerBall = 0.25, kGoneIn = 0.5;

/// What comes closer by less than this share of the fastest is another matter: it settles, or the
/// ground it slides on gives way a little.
constexpr double kOfFastest = 0.1;

/// Nobody knows how bodies go on for longer, in steps.
constexpr double kFarAhead = 8.0;

/// How often a pair is looked at where it will be: each look says when to look next, and two or
/// three find a blow.
constexpr int kMostLooks = 8;

/// Round surfaces that slide along each other by more than this share of the smaller body until
/// they meet do so along another normal than they have now.
constexpr double kSlidesOn = 2e-3;

/// And if it turns by no more than this, they do not [rad]: what rolls on a flat face as it lands
/// has places to touch that come and go.
constexpr double kTurned = 1e-5;

/// The moment of a blow is known when it changes by less than this share of the step.
constexpr double kSameMoment = 1e-6;

bool isOfCorner(const GapContact& contact)
{
    const FeatureKind kind = kindOf(contact.feature);
    return kind == FeatureKind::cornerOfA || kind == FeatureKind::cornerOfB;
}

Mat3 turnOf(const Pose& before, const Pose& now)
{
    return (now.orientation * before.orientation.conjugate()).toRotationMatrix();
}

}  // namespace

Course::Course(const World& world, const GapScratch& scratch, const std::vector<Held>& held,
               BodyId id)
    : start(world.motion[id].worldFromBody())
{
    const GapBody& body = scratch.bodies[id];
    const Held& by = held[scratch.placeInBlock[id]];
    velocity = body.velocity;
    spin = body.spin;
    acceleration = body.pull + by.acceleration;
    turning = body.inverseInertia * (body.torque - spin.cross(world.motion[id].angularMomentum)) +
              by.turning;
}

Pose Course::poseAt(double t) const
{
    Pose pose{placeAt(t), start.orientation};
    const Vec3 turn = t * spin + 0.5 * t * t * turning;
    if (!turn.isZero(0.0)) pose.orientation = rotated(pose.orientation, turn);
    return pose;
}

PairForesight::PairForesight(const World& world, const std::vector<Held>& held, GapScratch& scratch,
                             const GapPair& pair, double dt, double fastest,
                             std::vector<GapContact>& room)
    : world_(world),
      scratch_(scratch),
      bodies_(pair.bodies),
      near_(scratch.nearPairs[pair.nearPair].features),
      a_(world, scratch, held, bodies_.a),
      b_(world, scratch, held, bodies_.b),
      dt_(dt),
      fastEnough_(kOfFastest * fastest),
      found_(room)
{
    after_ = kAfter * smallerRadius(world, bodies_.a, bodies_.b);
    for (const BodyId body : {bodies_.a, bodies_.b}) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane) continue;
        after_ = std::min(
            {after_, kOfThickness * shape.thickness(), kOfInnerBall * shape.innerBall.radius});
    }
}

bool PairForesight::passes(const std::vector<GapContact>& contacts)
{
    Blow blow = nextBlow(contacts, 0.0, fastEnough_);
    for (int look = 0; look < kMostLooks; ++look) {
        if (blow.time >= dt_) return look > 0;
        const double t = blow.time + after_ / blow.speed;
        if (t > kFarAhead * dt_) return false;
        if (goesIn(blow, t)) return false;
        lookAt(t, 0.0);
        if (deepestOf(found_) >= kGoneIn * after_) return false;
        lookAt(t, std::max(dt_ - t, 0.0) * fastestOfAll());
        blow = nextBlow(found_, t, fastEnough_);
    }
    return false;
}

double PairForesight::aim(const std::vector<GapContact>& contacts, std::span<GapRow> rows)
{
    const Blow first = nextBlow(contacts, 0.0, fastEnough_);
    if (!first.contact) return kNotKnown;
    const auto take = [&](double t, const auto& thenOf) {
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const GapContact* then = bears(rows[r]) ? nullptr : thenOf(r);
            if (then && velocityOf(*then, t).dot(then->normal) < 0.0) takeFrom(*then, t, rows[r]);
        }
        return t;
    };
    switch (kindOf(first.contact->feature)) {
        case FeatureKind::round: {
            if (!slidesUntil(first)) return kNotKnown;
            return take(lookForBlow(first), [&](std::size_t r) -> const GapContact* {
                if (kindOf(contacts[r].feature) != FeatureKind::round) return nullptr;
                const GapContact* then = sameAs(contacts[r]);
                if (!then || (then->normal - contacts[r].normal).norm() <= kTurned) return nullptr;
                return then;
            });
        }
        case FeatureKind::edges: {
            if (!turnsUntil(first)) return kNotKnown;
            return take(lookForBlow(first), [&](std::size_t r) { return sameAs(contacts[r]); });
        }
        default: {
            const double t = turnsUntil(first) ? goAlongToBlow(contacts) : kNotKnown;
            if (t == kNotKnown) return t;
            return take(
                t, [&](std::size_t r) { return isOfCorner(contacts[r]) ? &found_[r] : nullptr; });
        }
    }
}

bool PairForesight::slidesUntil(const Blow& blow) const
{
    const Vec3 v = a_.velocity - b_.velocity;
    const Vec3& n = blow.contact->normal;
    return std::min(blow.time, dt_) * (v - v.dot(n) * n).norm() >
           kSlidesOn * smallerRadius(world_, bodies_.a, bodies_.b);
}

bool PairForesight::turnsUntil(const Blow& blow) const
{
    return std::min(blow.time, dt_) * (a_.spin.norm() + b_.spin.norm()) > kTurnsOn;
}

/// By looks; at the end of the step if they miss. Leaves in found_ what there is then.
double PairForesight::lookForBlow(Blow blow)
{
    const double reach = 2.0 * std::max(blow.contact->gap, after_);
    double t = 0.0;
    for (int look = 0; look < kMostLooks; ++look) {
        const double next = std::min(blow.time, dt_);
        if (look > 0 && next - t <= kSameMoment * dt_) break;
        t = next;
        lookAt(t, reach);
        blow = nextBlow(found_, t, 0.0);
    }
    return t;
}

/// Of contacts that go along with their bodies, if they hit within the step. Leaves in found_
/// how they are then.
double PairForesight::goAlongToBlow(const std::vector<GapContact>& contacts)
{
    double t = 0.0;
    for (int look = 0; look < kMostLooks; ++look) {
        goAlong(contacts, t);
        double next = std::numeric_limits<double>::infinity();
        for (const GapContact& contact : found_) {
            const double u = velocityOf(contact, t).dot(contact.normal);
            if (-u > fastEnough_) next = std::min(next, t + contact.gap / -u);
        }
        next = std::max(next, 0.0);
        if (next > dt_) return kNotKnown;
        if (std::abs(next - t) <= kSameMoment * dt_) return t;
        t = next;
    }
    return kNotKnown;
}

void PairForesight::goAlong(const std::vector<GapContact>& contacts, double t)
{
    const Pose a = a_.poseAt(t), b = b_.poseAt(t);
    const PairMove move{turnOf(a_.start, a), turnOf(b_.start, b),
                        b_.start.position - a_.start.position, b.position - a.position};
    found_.clear();
    for (const GapContact& contact : contacts) found_.push_back(movedAlong(contact, move));
}

/// Of what was found last.
const GapContact* PairForesight::sameAs(const GapContact& contact) const
{
    const GapContact* nearest = nullptr;
    const auto away = [&](const GapContact& other) {
        return (other.rA - contact.rA).squaredNorm();
    };
    for (const GapContact& other : found_) {
        if (other.feature != contact.feature) continue;
        if (!nearest || away(other) < away(*nearest)) nearest = &other;
    }
    return nearest;
}

void PairForesight::takeFrom(const GapContact& contact, double t, GapRow& row) const
{
    row.rA = contact.rA;
    row.rB = contact.rA + a_.placeAt(t) - b_.placeAt(t);
    row.normal = contact.normal;
    row.isOfBlow = true;
    row.gap = contact.gap;
}

Vec3 PairForesight::velocityOf(const GapContact& contact, double t) const
{
    const Vec3 bFromA = a_.placeAt(t) - b_.placeAt(t);
    return a_.velocityAt(contact.rA, t) - b_.velocityAt(contact.rA + bFromA, t);
}

/// Of what comes closer faster than that.
PairForesight::Blow PairForesight::nextBlow(const std::vector<GapContact>& contacts, double t,
                                            double speed) const
{
    const Vec3 acceleration = a_.acceleration - b_.acceleration;
    Blow first;
    for (const GapContact& contact : contacts) {
        const double u = velocityOf(contact, t).dot(contact.normal);
        if (-u <= speed) continue;
        const double g = acceleration.dot(contact.normal);
        const double atMost = -u - std::min(0.5 * g * (dt_ - t), 0.0);
        const double time = t + std::max(contact.gap, 0.0) / atMost;
        if (time < first.time) first = {time, atMost, t, &contact};
    }
    return first;
}

/// Whether one of the two places has gone into the other body: nearly all do, and to ask for
/// them costs next to nothing beside a look.
bool PairForesight::goesIn(const Blow& blow, double t) const
{
    const Pose a = a_.poseAt(blow.seenAt), b = b_.poseAt(blow.seenAt);
    const Pose aThen = a_.poseAt(t), bThen = b_.poseAt(t);
    const Vec3 half = 0.5 * blow.contact->gap * blow.contact->normal;
    const Vec3 middle = a.position + blow.contact->rA;
    const Vec3 onA = aThen * (inverse(a) * (middle + half));
    const Vec3 onB = bThen * (inverse(b) * (middle - half));
    const Shape &shapeA = world_.shapeOf(bodies_.a), &shapeB = world_.shapeOf(bodies_.b);
    return std::min(shapeB.distance.value(inverse(bThen) * onA),
                    shapeA.distance.value(inverse(aThen) * onB)) <= -kGoneIn * after_;
}

double PairForesight::fastestOfAll() const
{
    return scratch_.paces[bodies_.a].fastest(dt_) + scratch_.paces[bodies_.b].fastest(dt_);
}

void PairForesight::lookAt(double t, double reach)
{
    const PlacedPair placed{&world_.shapeOf(bodies_.a), &world_.shapeOf(bodies_.b), a_.poseAt(t),
                            b_.poseAt(t)};
    found_.clear();
    near_.findContacts(placed, reach, found_);
}

}  // namespace scree
