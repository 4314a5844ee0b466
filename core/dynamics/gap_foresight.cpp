// Symbols: u normal velocity (approaching < 0), t time since the step began.
#include "core/dynamics/gap_foresight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/dynamics/body_pairs.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What comes closer by less than this share of the smaller body in a step stops at nothing.
constexpr double kSlow = 1e-4;

/// How far after a blow bodies are looked at, as a share of the smaller one and of what is thin in
/// either; and the share of that by which they must have gone in.
constexpr double kAfter = 5e-3, kOfThickness = 0.25, kGoneIn = 0.5;

/// What comes closer by less than this share of the fastest is another matter: it settles, or the
/// ground it slides on gives way a little.
constexpr double kOfFastest = 0.1;

/// Nobody knows how bodies go on for longer, in steps.
constexpr double kFarAhead = 8.0;

/// What passes is let through by so much more than it takes: by rounding it would seem to bear.
constexpr double kSpare = 1e-6;

constexpr int kMostLooks = 8;

/// Round surfaces that slide along each other by more than this share of the smaller body until
/// they meet do so along another normal than they have now.
constexpr double kSlidesOn = 2e-3;

/// And if it turns by no more than this, they do not [rad]: what rolls on a flat face as it lands
/// has places to touch that come and go.
constexpr double kTurned = 1e-5;

/// The moment of a blow is known when it changes by less than this share of the step.
constexpr double kSameMoment = 1e-6;

/// A body on its way, if what carried it in the last step still does.
struct Course {
    Pose start;
    Vec3 velocity, spin, acceleration, turning;

    Course(const World& world, const GapScratch& scratch, const std::vector<Held>& held, BodyId id)
        : start(world.motion[id].worldFromBody())
    {
        const GapBody& body = scratch.bodies[id];
        const Held& by = held[scratch.placeInBlock[id]];
        velocity = body.velocity;
        spin = body.spin;
        acceleration = body.pull + by.acceleration;
        turning = body.inverseInertia * body.torque + by.turning;
    }

    Vec3 velocityAt(const Vec3& r, double t) const
    {
        return velocity + t * acceleration + (spin + t * turning).cross(r);
    }
    Vec3 placeAt(double t) const
    {
        return start.position + t * velocity + 0.5 * t * t * acceleration;
    }
    Pose poseAt(double t) const
    {
        Pose pose{placeAt(t), start.orientation};
        const Vec3 turn = t * spin + 0.5 * t * t * turning;
        if (!turn.isZero(0.0)) pose.orientation = rotated(pose.orientation, turn);
        return pose;
    }
};

struct Blow {
    double time = std::numeric_limits<double>::infinity();
    double speed = 0.0;   // at which the surfaces meet [m/s]
    double seenAt = 0.0;  // when the bodies were where the contact is
    const GapContact* contact = nullptr;
};

/// What already bears is there to be borne by.
bool bears(const GapRow& row)
{
    return row.impulse.x() > 0.0;
}

/// A pair on its way, of which something comes closer as fast as that.
class Foresight {
public:
    Foresight(const World& world, const std::vector<Held>& held, GapScratch& scratch,
              const GapPair& pair, double dt, double fastest)
        : world_(world),
          scratch_(scratch),
          bodies_(pair.bodies),
          near_(scratch.nearPairs[pair.near].near),
          a_(world, scratch, held, bodies_.a),
          b_(world, scratch, held, bodies_.b),
          dt_(dt),
          fastEnough_(kOfFastest * fastest)
    {
        const double thinner =
            std::min(world.shapeOf(bodies_.a).thickness(), world.shapeOf(bodies_.b).thickness());
        after_ =
            std::min(kAfter * smallerRadius(world, bodies_.a, bodies_.b), kOfThickness * thinner);
    }

    bool isFast(double u) const { return -u > fastEnough_; }

    /// Whether what is about to be hit in this step is not.
    bool passes(const std::vector<GapContact>& contacts)
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

    /// Takes the rows of round surfaces that slide along each other until they meet from where
    /// they are then, or at the end of the step if they miss.
    void aim(const std::vector<GapContact>& contacts, std::span<GapRow> rows)
    {
        Blow blow = nextBlow(contacts, 0.0, fastEnough_);
        if (!blow.contact || !turnsUntil(blow)) return;
        const double reach = 2.0 * std::max(blow.contact->gap, after_);
        double t = 0.0;
        for (int look = 0; look < kMostLooks; ++look) {
            const double next = std::min(blow.time, dt_);
            if (look > 0 && next - t <= kSameMoment * dt_) break;
            t = next;
            lookAt(t, reach);
            blow = nextBlow(found_, t, 0.0);
        }
        for (GapRow& row : rows) {
            const GapContact& contact = contacts[&row - rows.data()];
            if (bears(row) || kindOf(contact.feature) != FeatureKind::round) continue;
            const GapContact* then = sameAs(contact);
            if (then && (then->normal - contact.normal).norm() > kTurned) takeFrom(*then, t, row);
        }
    }

private:
    bool turnsUntil(const Blow& blow) const
    {
        if (kindOf(blow.contact->feature) != FeatureKind::round) return false;
        const Vec3 v = a_.velocity - b_.velocity;
        const Vec3& n = blow.contact->normal;
        return std::min(blow.time, dt_) * (v - v.dot(n) * n).norm() >
               kSlidesOn * smallerRadius(world_, bodies_.a, bodies_.b);
    }

    /// Of what was found last.
    const GapContact* sameAs(const GapContact& contact) const
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

    /// With the gap that closes when that of `contact` does.
    void takeFrom(const GapContact& contact, double t, GapRow& row) const
    {
        row.rA = contact.rA;
        row.rB = contact.rA + a_.placeAt(t) - b_.placeAt(t);
        row.normal = contact.normal;
        row.isOfBlow = true;
        const double u =
            velocityAt(row, scratch_.bodies[bodies_.a], scratch_.bodies[bodies_.b]).dot(row.normal);
        const double g = (a_.acceleration - b_.acceleration).dot(row.normal);
        row.gap = contact.gap - t * (u + 0.5 * g * t);
        prepareRow(scratch_.bodies, row);
    }

    Vec3 velocityOf(const GapContact& contact, double t) const
    {
        const Vec3 bFromA = a_.placeAt(t) - b_.placeAt(t);
        return a_.velocityAt(contact.rA, t) - b_.velocityAt(contact.rA + bFromA, t);
    }

    /// Of what comes closer faster than that.
    Blow nextBlow(const std::vector<GapContact>& contacts, double t, double speed) const
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
    bool goesIn(const Blow& blow, double t) const
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

    double fastestOfAll() const
    {
        return scratch_.paces[bodies_.a].fastest(dt_) + scratch_.paces[bodies_.b].fastest(dt_);
    }

    void lookAt(double t, double reach)
    {
        const PlacedPair placed{&world_.shapeOf(bodies_.a), &world_.shapeOf(bodies_.b),
                                a_.poseAt(t), b_.poseAt(t)};
        found_.clear();
        near_.findContacts(placed, reach, found_);
    }

    const World& world_;
    const GapScratch& scratch_;
    BodyPair bodies_;
    NearFeatures& near_;
    Course a_, b_;
    double dt_, fastEnough_, after_;
    std::vector<GapContact> found_;
};

/// By how much a row is closed at the end of the step, where nothing else happens [m].
double closedBy(const GapScratch& scratch, const GapRow& row, double u, double dt)
{
    const double g = (scratch.bodies[row.a].pull - scratch.bodies[row.b].pull).dot(row.normal);
    return -(std::max(row.gap, 0.0) + dt * (u + 0.5 * g * dt));
}

}  // namespace

void foreseeBlows(const World& world, double dt, const std::vector<Held>& held,
                  const GapBlock& block, GapScratch& scratch)
{
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        // A plane is everywhere ahead of what comes down on it.
        if (world.shapeOf(pair.bodies.a).isPlane || world.shapeOf(pair.bodies.b).isPlane) return;
        const std::span rows(&scratch.rows[pair.begin], pair.end - pair.begin);
        const auto speedOf = [&](const GapRow& row) {
            return velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]).dot(row.normal);
        };
        const double slow = kSlow * smallerRadius(world, pair.bodies.a, pair.bodies.b) / dt;
        double fastest = slow;
        for (const GapRow& row : rows) {
            if (bears(row)) continue;
            const double u = speedOf(row);
            if (-u > fastest && closedBy(scratch, row, u, dt) > 0.0) fastest = -u;
        }
        if (fastest == slow) return;
        Foresight foresight(world, held, scratch, pair, dt, fastest);
        const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
        if (!foresight.passes(contacts)) return foresight.aim(contacts, rows);
        for (GapRow& row : rows) {
            const double u = speedOf(row);
            if (bears(row) || !foresight.isFast(u)) continue;
            const double closed = std::max(closedBy(scratch, row, u, dt), 0.0);
            row.gap = std::max(row.gap, 0.0) + (1.0 + kSpare) * closed;
        }
    });
}

}  // namespace scree
