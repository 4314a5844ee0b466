#include "core/dynamics/sleep.h"
#include "core/base/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/collision/broad_phase.h"
#include "core/collision/near_features.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// A body that stays within this share of its size of one place is still: an eighth of a millimetre
/// on a ring of 2.5 m. A domino at the point of falling passes it within a few frames.
constexpr double kStill = 1e-4;

/// For so long, in √(size / acceleration), half a second for that ring, and for so many frames: a
/// tower that is leaning has to show it, also where a second has a thousand frames.
constexpr double kStillTime = 1.4;
constexpr std::int32_t kStillFrames = 12;
constexpr std::int32_t kCheckShare = 3;  // of that for one that has been woken and did not move

/// What goes farther than this share of its size in a frame does not lie where it is seen at the
/// end of each: it may have turned once around.
constexpr double kFarInAFrame = 0.5;

/// What has stayed within this share of its size of one place for kSettleWait loses its motion by
/// and by, 1/e of it in kSettleTime; both times in √(size / acceleration), a third of a second for
/// that ring, so that a tower takes as long to fall as it should.
constexpr double kNearby = 0.05;
constexpr double kSettleWait = 6.0, kSettleTime = 1.5;

/// But not what goes on and on, however slowly: what has come at least this share of what it would
/// have in kSettleWait with the velocity it has. What speeds up evenly from rest has come half of
/// that by then, and what rocks comes back; with a quarter a plank that rocked on a ball took as
/// long again. Calmed like the others, a block on a slope barely steeper than friction holds was
/// 6 cm from its place after 10 s, not half a metre.
constexpr double kGoesOn = 0.45;
/// As long as it goes by this share of its size in that time: cubes that settled by less than that
/// kept a heap of a thousand awake for a second longer.
constexpr double kCreeps = 4e-3;

/// What does not balance of the forces on a body, as a share of those of its contacts: below the
/// first it may fall asleep, above the second it wakes. What sleeps for good hardly changes the
/// load of its neighbours; what comes to lie on a body of its own weight adds a third.
constexpr double kBalanced = 0.02, kUnbalanced = 0.1;

/// What gives a sleeper less than this share of √(size · acceleration) in a step, 4 cm/s for that
/// ring, is no blow: it learns of it by its load, after the step.
constexpr double kGentle = 0.01;

/// Of the time scale on which a body gives way to an acceleration [s]; infinite without any.
double unitOfTime(const World& world, BodyId body, double acceleration)
{
    return std::sqrt(world.shapeOf(body).boundingRadius / acceleration);
}

/// How long a body must lie still, in frames.
double framesToSleep(const World& world, BodyId body, double acceleration)
{
    const double time = kStillTime * unitOfTime(world, body, acceleration);
    return std::max(std::ceil(time / world.frameDuration), double{kStillFrames});
}

void wake(World& world, BodyId body)
{
    BodyRest& rest = world.contactMemory.rest[body];
    const double pull = rest.pull.norm();
    const double frames = pull > 0.0 ? framesToSleep(world, body, pull) : double{kStillFrames};
    rest.isAsleep = false;
    rest.still.frames = static_cast<std::int32_t>(frames - std::floor(frames / kCheckShare));
}

/// Upper bound of how far a point of the body has come from where it was.
double travelled(const World& world, BodyId body, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double turned = 2.0 * (motion.orientation * since.orientation.conjugate()).vec().norm();
    return (motion.position - since.position).norm() + turned * world.shapeOf(body).boundingRadius;
}

bool goesFarInAFrame(const World& world, BodyId body)
{
    const BodyMotion& motion = world.motion[body];
    const PassInertia inertia = passInertia(world.mass[body], motion.orientation);
    const double radius = world.shapeOf(body).boundingRadius;
    const Vec3 spin = inertia.inverseInertia * motion.angularMomentum;
    const double speed = motion.velocity.norm() + spin.norm() * radius;
    return speed * world.frameDuration > kFarInAFrame * radius;
}

/// One more frame within `share` of its size of the place, or a new place.
void goOn(const World& world, BodyId body, double share, Stay& stay)
{
    const double allowed = share * world.shapeOf(body).boundingRadius;
    if (travelled(world, body, stay) <= allowed && !goesFarInAFrame(world, body)) {
        ++stay.frames;
    } else {
        stay = {world.motion[body].position, world.motion[body].orientation, 0};
    }
}

/// Whether a body moves on from where it was, and has for as long as that.
bool goesOn(const World& world, BodyId body, double time, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double radius = world.shapeOf(body).boundingRadius;
    const Vec3 way = motion.position - since.position;
    const Vec3 turn = radius * rotationVector(motion.orientation * since.orientation.conjugate());
    const Vec3 speedOfTurn = radius * angularVelocity(motion, world.mass[body]);
    const double along = way.dot(motion.velocity) + turn.dot(speedOfTurn);
    const double speeds = motion.velocity.squaredNorm() + speedOfTurn.squaredNorm();
    return time * std::sqrt(speeds) >= kCreeps * radius && along >= kGoesOn * time * speeds;
}

/// A ring that leans on two others and rocks loses next to nothing at each swing: nothing in a
/// world of rigid bodies takes that energy, and one such ring keeps a whole heap awake.
void settle(World& world, BodyId body, double acceleration, const Stay& nearby)
{
    if (acceleration == 0.0) return;
    const double unit = unitOfTime(world, body, acceleration);
    const double wait = kSettleWait * unit;
    if (nearby.frames * world.frameDuration < wait || goesOn(world, body, wait, nearby)) return;
    const double kept = 1.0 / (1.0 + world.frameDuration / (kSettleTime * unit));
    world.motion[body].velocity *= kept;
    world.motion[body].angularMomentum *= kept;
}

/// From a body that is struck, sleepers wake this many contacts far; those beyond feel it by their
/// loads.
constexpr int kWakeFar = 2;

/// Wakes `roots` and the sleepers around them. What was put to sleep touching, before any force
/// acted, wakes together.
void wakeAround(World& world, const std::vector<BodyId>& roots)
{
    DisjointSets sets(world.bodyCount());
    std::vector<const RememberedContact*> bearing;
    const ContactMemory& memory = world.contactMemory;
    for (const RememberedContact& contact : memory.contacts) {
        if (!memory.isAsleep(contact.a) || !memory.isAsleep(contact.b)) continue;
        if (contact.force.isZero(0.0))
            sets.join(static_cast<std::size_t>(contact.a), static_cast<std::size_t>(contact.b));
        else
            bearing.push_back(&contact);
    }
    const auto setOf = [&](BodyId body) { return sets.find(static_cast<std::size_t>(body)); };
    std::vector<char> wakes(world.bodyCount(), 0);
    for (const BodyId root : roots) wakes[setOf(root)] = 1;
    for (int far = 0; far < kWakeFar; ++far) {
        const std::vector<char> before = wakes;
        for (const RememberedContact* contact : bearing) {
            const std::size_t a = setOf(contact->a), b = setOf(contact->b);
            if (before[a] || before[b]) wakes[a] = wakes[b] = 1;
        }
    }
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (memory.isAsleep(body) && wakes[sets.find(i)]) wake(world, body);
    }
}

/// Sleepers that stand closer than this share of the smaller one's size touch. No force has made
/// them press on each other yet, so the eye decides.
constexpr double kTouching = 0.01;

/// Contacts without force of sleeping bodies with each other, which wakeAround follows, and with
/// those that a script may take away.
std::vector<RememberedContact> contactsOfSleepers(const World& world)
{
    std::vector<Aabb> boxes(world.bodyCount());
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        const bool isScripted = world.info[i].kind == BodyKind::keyed && world.isBorn(body);
        if (!world.contactMemory.isAsleep(body) && !isScripted) continue;
        const Shape& shape = world.shapeOf(body);
        boxes[i] = boxAt(shape, world.motion[i].worldFromBody())
                       .grown(0.5 * kTouching * shape.boundingRadius);
    }
    BroadPhase broadPhase;
    std::vector<RememberedContact> found;
    std::vector<GapContact> contacts;
    const auto counts = [&](BodyPair pair) { return mayCollide(world, pair); };
    for (const BodyPair& pair : broadPhase.findPairs(boxes, world.mass, counts)) {
        contacts.clear();
        NearFeatures().findContacts(placePair(world, pair),
                                    kTouching * smallerRadius(world, pair.a, pair.b), contacts);
        if (contacts.empty()) continue;
        const Quat aFromWorld = world.motion[pair.a].orientation.conjugate();
        found.push_back({pair.a, pair.b, contacts.front().feature, aFromWorld * contacts.front().rA,
                         Vec3::Zero()});
    }
    return found;
}

/// What the contacts of a body do to it.
struct ContactLoad {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // about its centre of mass, world [N], [N m]
    double total = 0.0;                                // of the magnitudes of the forces [N]

    void add(const Vec3& r, const Vec3& f, const Vec3& couple)
    {
        force += f;
        torque += r.cross(f) + couple;
        total += f.norm();
    }
};

void addContact(const World& world, const RememberedContact& contact,
                std::vector<ContactLoad>& loads)
{
    const BodyMotion &a = world.motion[contact.a], &b = world.motion[contact.b];
    const Vec3 r = a.orientation * contact.place;
    loads[contact.a].add(r, contact.force, contact.couple);
    loads[contact.b].add(a.position + r - b.position, -contact.force, -contact.couple);
}

/// Of the remembered contacts that `counts` accepts, told their bodies.
template <class Counts>
std::vector<ContactLoad> contactLoads(const World& world, const Counts& counts)
{
    std::vector<ContactLoad> loads(world.bodyCount());
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (counts(contact.a, contact.b)) addContact(world, contact, loads);
    }
    return loads;
}

bool touchesSleeper(const World& world, BodyId a, BodyId b)
{
    return world.contactMemory.isAsleep(a) || world.contactMemory.isAsleep(b);
}

/// Right for sleepers alone.
std::vector<ContactLoad> loadsOfSleepers(const World& world)
{
    return contactLoads(world, [&](BodyId a, BodyId b) { return touchesSleeper(world, a, b); });
}

/// The sleepers that have rows in this step, in order.
std::vector<BodyId> touchedSleepers(const World& world, const GapScratch& scratch)
{
    std::vector<BodyId> touched;
    for (const GapPair& pair : scratch.pairs) {
        for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
            if (world.contactMemory.isAsleep(body)) touched.push_back(body);
        }
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    return touched;
}

/// Those of a step that is not over, right for some sleepers alone: what lies between sleepers is
/// remembered, the rest solved.
std::vector<ContactLoad> loadsOf(const std::vector<BodyId>& sleepers, const World& world, double dt,
                                 const GapScratch& scratch)
{
    std::vector<char> isOne(world.bodyCount(), 0);
    for (const BodyId body : sleepers) isOne[body] = 1;
    std::vector<ContactLoad> loads = contactLoads(world, [&](BodyId a, BodyId b) {
        return (isOne[a] || isOne[b]) && !world.isStepped(a) && !world.isStepped(b);
    });
    const auto add = [&](const GapRow& row, const Vec3& impulse, const Vec3& couple) {
        loads[row.a].add(row.rA, impulse / dt, couple / dt);
        loads[row.b].add(row.rB, -impulse / dt, -couple / dt);
    };
    for (const std::size_t i : scratch.order) {
        const GapPair& pair = scratch.pairs[i];
        if (!isOne[pair.bodies.a] && !isOne[pair.bodies.b]) continue;
        for (std::size_t r = pair.begin; r < pair.end; ++r)
            add(scratch.rows[r], scratch.rows[r].worldImpulse(), scratch.rows[r].couple);
    }
    for (const GapImpact& impact : scratch.impacts)
        add(scratch.rows[impact.row], impact.impulse, Vec3::Zero());
    return loads;
}

/// What was put to sleep where it is, held up or not, and has not been touched yet. It has never
/// been seen to lie still.
bool awaitsTouch(const World& world, BodyId body, const ContactLoad& load)
{
    return load.total == 0.0 && world.contactMemory.rest[body].still.frames < kStillFrames;
}

/// What remains of the forces on a body when those that hold it are taken off.
struct Unbalance {
    double force, torque;  // [N], [N m]

    Unbalance(const World& world, BodyId body, const ContactLoad& load, const AppliedForce& other)
        : force((load.force + other.acceleration / world.mass[body].inverseMass).norm()),
          torque((load.torque + other.torque).norm())
    {
    }
};

/// Whether the forces on a body cancel but for a share of those of its contacts.
bool isBalanced(const World& world, BodyId body, const ContactLoad& load, const AppliedForce& other,
                double share)
{
    const Unbalance rest(world, body, load, other);
    const double allowed = share * load.total;
    return rest.force <= allowed && rest.torque <= allowed * world.shapeOf(body).boundingRadius;
}

/// Whether a body that has not been seen to move for so many frames, and on which nothing but what
/// balances acts, lies. What flies where nothing pulls does not.
bool liesStill(const World& world, BodyId body, double frames, const ContactLoad& load,
               const AppliedForce& other)
{
    const BodyMotion& motion = world.motion[body];
    if (motion.velocity.isZero(0.0) && motion.angularMomentum.isZero(0.0))
        return frames >= kStillFrames;
    const double held = load.total * world.mass[body].inverseMass;
    const double acceleration = std::max(other.acceleration.norm(), held);
    return acceleration > 0.0 && frames >= framesToSleep(world, body, acceleration);
}

/// Whether the impulse of a row on a body holds it up against what pulls it; in a world without
/// pull everything that touches does.
bool isHeldUpBy(const GapRow& row, const Vec3& impulse, const Vec3& pull)
{
    return impulse.dot(-pull) > kBalanced * row.impulse.norm() * pull.norm() || pull.isZero(0.0);
}

/// Who of the still bodies may sleep: nothing that is awake, and nothing that a script moves, holds
/// one of them up.
void keepWhoIsHeldUp(const World& world, const GapScratch& scratch, std::vector<char>& maySleep)
{
    const auto lies = [&](BodyId body) {
        return maySleep[body] || world.contactMemory.isAsleep(body) ||
               (scratch.bodies[body].inverseMass == 0.0 && !isDriven(scratch.bodies[body]));
    };
    bool isSettled = false;
    while (!isSettled) {
        isSettled = true;
        for (const std::size_t i : scratch.order) {  // bottom to top: few rounds
            for (std::size_t r = scratch.pairs[i].begin; r < scratch.pairs[i].end; ++r) {
                const GapRow& row = scratch.rows[r];
                if (row.impulse.x() == 0.0) continue;
                const Vec3 impulse = row.worldImpulse();
                const auto wakeIfHeldUp = [&](BodyId body, BodyId by, const Vec3& push) {
                    if (!maySleep[body] || lies(by)) return;
                    if (!isHeldUpBy(row, push, scratch.forces[body].acceleration)) return;
                    maySleep[body] = 0;
                    isSettled = false;
                };
                wakeIfHeldUp(row.a, row.b, impulse);
                wakeIfHeldUp(row.b, row.a, -impulse);
            }
        }
    }
}

bool anyAsleep(const World& world)
{
    return std::ranges::any_of(world.contactMemory.rest, &BodyRest::isAsleep);
}

}  // namespace

void sleepFromTheStart(World& world, const StepSettings& settings,
                       const std::vector<BodyId>& bodies)
{
    if (bodies.empty()) return;
    std::vector<AppliedForce> forces;
    findForces(world, settings, world.frameDuration, forces);
    world.contactMemory.rest.resize(world.bodyCount());
    for (const BodyId body : bodies) {
        const BodyMotion& motion = world.motion[body];
        const Stay here{motion.position, motion.orientation, 0};
        world.contactMemory.rest[body] = {here, here, forces[body].acceleration, true};
    }
    world.contactMemory.contacts = contactsOfSleepers(world);
}

void fallAsleep(World& world, const GapScratch& scratch)
{
    std::vector<BodyRest>& rest = world.contactMemory.rest;
    rest.resize(world.bodyCount());
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!world.isStepped(body)) continue;
        goOn(world, body, kStill, rest[i].still);
        goOn(world, body, kNearby, rest[i].nearby);
    }

    // What a script moves is not to be calmed, nor what lies on it.
    DisjointSets sets(world.bodyCount());
    std::vector<char> isCarried(world.bodyCount(), 0), isDrivenSet(world.bodyCount(), 0);
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
        isCarried[a] = isCarried[b] = 1;
        if (world.isStepped(row.a) && world.isStepped(row.b)) sets.join(a, b);
    }
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        for (const auto& [carrier, carried] : {std::pair{row.a, row.b}, std::pair{row.b, row.a}}) {
            if (isDriven(scratch.bodies[carrier]))
                isDrivenSet[sets.find(static_cast<std::size_t>(carried))] = 1;
        }
    }

    const std::vector<ContactLoad> loads = contactLoads(world, [](BodyId, BodyId) { return true; });
    std::vector<char> maySleep(world.bodyCount(), 0);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!world.isStepped(body)) continue;
        maySleep[i] = liesStill(world, body, rest[i].still.frames, loads[i], scratch.forces[i]) &&
                      isBalanced(world, body, loads[i], scratch.forces[i], kBalanced);
        if (isCarried[i] && !isDrivenSet[sets.find(i)])
            settle(world, body, scratch.forces[i].acceleration.norm(), rest[i].nearby);
    }
    keepWhoIsHeldUp(world, scratch, maySleep);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (!maySleep[i]) continue;
        rest[i].isAsleep = true;
        rest[i].pull = scratch.forces[i].acceleration;
        world.motion[i].velocity = world.motion[i].angularMomentum = Vec3::Zero();
    }
}

bool wakeStruck(World& world, double dt, const GapScratch& scratch)
{
    if (!anyAsleep(world)) return false;
    // What nothing awake touches lies as the last step has left it.
    const std::vector<BodyId> touched = touchedSleepers(world, scratch);
    const std::vector<ContactLoad> loads = loadsOf(touched, world, dt, scratch);
    std::vector<BodyId> roots;
    for (const BodyId body : touched) {
        const ContactLoad& load = loads[body];
        if (awaitsTouch(world, body, load)) continue;
        const AppliedForce& other = scratch.forces[body];
        if (isBalanced(world, body, load, other, kUnbalanced)) continue;
        const double radius = world.shapeOf(body).boundingRadius;
        const Unbalance rest(world, body, load, other);
        const double speed =
            dt * world.mass[body].inverseMass * (rest.force + rest.torque / radius);
        if (speed > kGentle * std::sqrt(radius * other.acceleration.norm())) roots.push_back(body);
    }
    if (roots.empty()) return false;
    wakeAround(world, roots);
    return true;
}

void wakeUnbalanced(World& world, const std::vector<AppliedForce>& forces)
{
    if (!anyAsleep(world)) return;
    std::vector<BodyRest>& rest = world.contactMemory.rest;
    const std::vector<ContactLoad> loads = loadsOfSleepers(world);
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!rest[i].isAsleep || awaitsTouch(world, body, loads[i])) continue;
        if (isBalanced(world, body, loads[i], forces[i], kUnbalanced)) continue;
        wake(world, body);
    }
}

void wakeByForces(World& world, const std::vector<AppliedForce>& forces)
{
    std::vector<BodyId> roots;
    for (std::size_t i = 0; i < world.contactMemory.rest.size(); ++i) {
        const BodyRest& rest = world.contactMemory.rest[i];
        if (rest.isAsleep && rest.pull != forces[i].acceleration) {
            roots.push_back(static_cast<BodyId>(i));
        }
    }
    if (!roots.empty()) wakeAround(world, roots);
}

bool wakeByTouch(World& world, double dt, const GapScratch& scratch)
{
    if (!anyAsleep(world)) return false;
    std::vector<char> bears(world.bodyCount(), 0);
    std::vector<BodyId> roots;
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (!contact.force.isZero(0.0)) bears[contact.a] = bears[contact.b] = 1;
        const auto [a, b] = bodiesOf(contact);
        // What a script takes away from under a sleeper, or lets go there, comes no closer to it.
        for (const auto& [sleeper, other] : {std::pair{a, b}, std::pair{b, a}}) {
            if (!world.contactMemory.isAsleep(sleeper)) continue;
            const bool isLetGo =
                contact.force.isZero(0.0) && scratch.bodies[other].inverseMass > 0.0;
            if (isLetGo || isDriven(scratch.bodies[other])) roots.push_back(sleeper);
        }
    }
    for (const std::size_t i : scratch.toAsk) {
        const NearPair& pair = scratch.nearPairs[i];
        const auto [a, b] = pair.bodies;
        const bool aSleeps = world.contactMemory.isAsleep(a);
        if (aSleeps == world.contactMemory.isAsleep(b)) continue;
        const GapBody& bodyA = scratch.bodies[a];
        const GapBody& bodyB = scratch.bodies[b];
        const BodyId sleeper = aSleeps ? a : b, other = aSleeps ? b : a;
        // What may not move the other gives way to it; a load it would not feel.
        const bool mustGiveWay =
            isDriven(scratch.bodies[other]) || isUnmovedBy(world, other, sleeper);
        if (bears[sleeper] && !mustGiveWay) continue;
        const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
        for (const GapContact& contact : pair.contacts) {
            const Vec3 u = bodyA.velocity + dt * bodyA.pull + bodyA.spin.cross(contact.rA) -
                           bodyB.velocity - dt * bodyB.pull - bodyB.spin.cross(contact.rA + bFromA);
            if (std::max(contact.gap, 0.0) + dt * u.dot(contact.normal) >= 0.0) continue;
            roots.push_back(sleeper);
            break;
        }
    }
    if (roots.empty()) return false;
    wakeAround(world, roots);
    return true;
}

}  // namespace scree
