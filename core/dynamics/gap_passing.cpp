// Symbols: u normal velocity (approaching < 0), t time since the step began.
#include "core/dynamics/gap_passing.h"

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

constexpr int kMostLooks = 8;

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

/// A pair on its way, of which something comes closer as fast as that.
class Passing {
public:
    Passing(const World& world, const std::vector<Held>& held, GapScratch& scratch,
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
        Blow blow = nextBlow(contacts, 0.0);
        for (int look = 0; look < kMostLooks; ++look) {
            if (blow.time >= dt_) return look > 0;
            const double t = blow.time + after_ / blow.speed;
            if (t > kFarAhead * dt_) return false;
            if (goesIn(blow, t)) return false;
            lookAt(t, 0.0);
            if (deepestOf(found_) >= kGoneIn * after_) return false;
            lookAt(t, std::max(dt_ - t, 0.0) * fastestOfAll());
            blow = nextBlow(found_, t);
        }
        return false;
    }

private:
    Vec3 velocityAt(const GapContact& contact, double t) const
    {
        const Vec3 bFromA = a_.placeAt(t) - b_.placeAt(t);
        return a_.velocityAt(contact.rA, t) - b_.velocityAt(contact.rA + bFromA, t);
    }

    Blow nextBlow(const std::vector<GapContact>& contacts, double t) const
    {
        const Vec3 acceleration = a_.acceleration - b_.acceleration;
        Blow first;
        for (const GapContact& contact : contacts) {
            const double u = velocityAt(contact, t).dot(contact.normal);
            if (!isFast(u)) continue;
            const double g = acceleration.dot(contact.normal);
            const double speed = -u - std::min(0.5 * g * (dt_ - t), 0.0);
            const double time = t + std::max(contact.gap, 0.0) / speed;
            if (time < first.time) first = {time, speed, t, &contact};
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

void letPass(const World& world, double dt, const std::vector<Held>& held, const GapBlock& block,
             GapScratch& scratch)
{
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        // A plane is everywhere ahead of what comes down on it.
        if (world.shapeOf(pair.bodies.a).isPlane || world.shapeOf(pair.bodies.b).isPlane) return;
        const std::span rows(&scratch.rows[pair.begin], pair.end - pair.begin);
        const auto speedOf = [&](const GapRow& row) {
            return velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]).dot(row.normal);
        };
        // What already bears is there to be borne by.
        const auto bears = [](const GapRow& row) { return row.impulse.x() > 0.0; };
        const double slow = kSlow * smallerRadius(world, pair.bodies.a, pair.bodies.b) / dt;
        double fastest = slow;
        for (const GapRow& row : rows) {
            if (bears(row)) continue;
            const double u = speedOf(row);
            if (-u > fastest && closedBy(scratch, row, u, dt) > 0.0) fastest = -u;
        }
        if (fastest == slow) return;
        Passing passing(world, held, scratch, pair, dt, fastest);
        const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
        if (!passing.passes(contacts)) return;
        for (GapRow& row : rows) {
            const double u = speedOf(row);
            if (bears(row) || !passing.isFast(u)) continue;
            row.gap = std::max(row.gap, 0.0) + std::max(closedBy(scratch, row, u, dt), 0.0);
        }
    });
}

}  // namespace scree
