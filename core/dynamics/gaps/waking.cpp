// Symbols: u velocity of A's surface against B's at a contact.
#include "core/dynamics/gaps/waking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/sorted.h"
#include "core/dynamics/gaps/contact_load.h"
#include "core/dynamics/gaps/stillness.h"

namespace scree {
namespace {

/// So many checks, of those who have been woken and did not move, take as long as to fall asleep.
constexpr double kChecksPerSleep = 3.0;

/// What gives a sleeper less than this share of √(size · acceleration) in a step, 4 cm/s for a ring
/// of 2.5 m, is no blow: it learns of it by its load, after the step.
constexpr double kGentle = 0.01;

/// From a body that is struck, sleepers wake this many contacts far; those beyond feel it by their
/// loads.
constexpr int kWakeFar = 2;

bool anyAsleep(const World& world)
{
    return std::ranges::any_of(world.contactMemory.rest, &BodyRest::isAsleep);
}

/// Per body whether it sleeps: for loops over contacts, which would fetch two whole BodyRest each.
std::vector<char> sleepersOf(const World& world)
{
    std::vector<char> sleeps(world.bodyCount(), 0);
    std::ranges::transform(world.contactMemory.rest, sleeps.begin(), &BodyRest::isAsleep);
    return sleeps;
}

void wake(World& world, BodyId body)
{
    BodyRest& rest = world.contactMemory.rest[body];
    const double pull = rest.pull.norm();
    // What next to nothing pulls at takes for ever, which no counter holds.
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    const double frames =
        pull > 0.0 ? std::min(framesToSleep(world, body, pull), kMost) : double{kStillFrames};
    rest.isAsleep = false;
    rest.unbalancedFrames = 0;
    rest.still.frames = static_cast<std::int32_t>(frames - std::floor(frames / kChecksPerSleep));
}

/// Wakes `roots` and the sleepers around them; true when there are any. What was put to sleep
/// touching, before any force acted, wakes together.
bool wakeAround(World& world, const std::vector<BodyId>& roots)
{
    if (roots.empty()) return false;
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
    return true;
}

/// The sleepers that have rows in this step, in order.
std::vector<BodyId> touchedSleepers(const World& world, const GapScratch& scratch)
{
    const std::vector<char> sleeps = sleepersOf(world);
    std::vector<BodyId> touched;
    for (const GapPair& pair : scratch.pairs) {
        for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
            if (sleeps[body]) touched.push_back(body);
        }
    }
    sortUnique(touched);
    return touched;
}

/// The loads of some sleepers in a step that is not over, right for these alone: what lies between
/// sleepers is remembered, the rest solved.
std::vector<ContactLoad> loadsInStep(const std::vector<BodyId>& sleepers, const World& world,
                                     double dt, const GapScratch& scratch)
{
    std::vector<char> isOne(world.bodyCount(), 0);
    for (const BodyId body : sleepers) isOne[body] = 1;
    std::vector<ContactLoad> loads = rememberedLoads(world, [&](BodyId a, BodyId b) {
        return (isOne[a] || isOne[b]) && !world.isStepped(a) && !world.isStepped(b);
    });
    const auto add = [&](const GapRow& row, const Vec3& impulse, const Vec3& couple) {
        if (!row.isUnmovedA) loads[row.a].add(row.rA, impulse / dt, couple / dt);
        if (!row.isUnmovedB) loads[row.b].add(row.rB, -impulse / dt, -couple / dt);
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

/// Whether a sleeper feels a load that no longer balances.
bool isDisturbed(const World& world, BodyId body, const ContactLoad& load,
                 const AppliedForce& other)
{
    return !awaitsTouch(world, body, load) && !isBalanced(world, body, load, other, kUnbalanced);
}

/// Whether a load would give a sleeper more than a gentle push in a step of dt.
bool isBlow(const World& world, double dt, BodyId body, const ContactLoad& load,
            const AppliedForce& other)
{
    const double radius = world.shapeOf(body).boundingRadius;
    const Unbalance rest(world, body, load, other);
    const double speed = dt * world.mass[body].inverseMass * (rest.force + rest.torque / radius);
    return speed > kGentle * std::sqrt(radius * other.acceleration.norm());
}

/// The loads of those who sleep, right for these alone.
std::vector<ContactLoad> loadsOfSleepers(const World& world)
{
    const ContactMemory& memory = world.contactMemory;
    return rememberedLoads(
        world, [&](BodyId a, BodyId b) { return memory.isAsleep(a) || memory.isAsleep(b); });
}

/// Wakes those who for long enough to fall asleep have lain under what would not have let them.
/// What is awake beside them presses on steadily, too little to wake them at once: either they give
/// way, as a balanced plank does to what rolls along it, or their contacts carry that too and they
/// sleep again, balanced.
void wakeWhoIsUneasy(World& world, const std::vector<AppliedForce>& forces)
{
    ContactMemory& memory = world.contactMemory;
    const std::vector<ContactLoad> loads = loadsOfSleepers(world);
    std::vector<char> isTouched(world.bodyCount(), 0);  // by somebody awake
    for (const RememberedContact& contact : memory.contacts) {
        if (world.isStepped(contact.a)) isTouched[contact.b] = 1;
        if (world.isStepped(contact.b)) isTouched[contact.a] = 1;
    }
    for (std::size_t i = 0; i < memory.rest.size(); ++i) {
        const auto body = static_cast<BodyId>(i);
        BodyRest& rest = memory.rest[i];
        if (!rest.isAsleep) continue;
        const bool isEasy = !isTouched[i] || awaitsTouch(world, body, loads[i]) ||
                            isBalanced(world, body, loads[i], forces[i], kBalanced);
        rest.unbalancedFrames = isEasy ? 0 : rest.unbalancedFrames + 1;
        if (rest.unbalancedFrames >= framesToSleep(world, body, rest.pull.norm()))
            wake(world, body);
    }
}

/// Adds the sleepers that something leaves which a script moves, or that it lets go: it comes no
/// closer to them, so that no contact would tell.
void addWhoIsLeft(const World& world, const GapScratch& scratch, const std::vector<char>& sleeps,
                  std::vector<BodyId>& roots)
{
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        const auto [a, b] = bodiesOf(contact);
        for (const auto& [sleeper, other] : {std::pair{a, b}, std::pair{b, a}}) {
            if (!sleeps[sleeper]) continue;
            const bool isLetGo = contact.force.isZero(0.0) && scratch.bodies[other].isMovable();
            if (isLetGo || isDriven(scratch.bodies[other])) roots.push_back(sleeper);
        }
    }
}

/// Whether a contact of a pair closes within the step, as its bodies move now.
bool willTouch(const World& world, double dt, const GapScratch& scratch, const NearPair& pair)
{
    const auto [idA, idB] = pair.bodies;
    const GapBody& a = scratch.bodies[idA];
    const GapBody& b = scratch.bodies[idB];
    const Vec3 bFromA = world.motion[idA].position - world.motion[idB].position;
    return std::ranges::any_of(pair.contacts, [&](const GapContact& contact) {
        const Vec3 u = a.velocity + dt * a.pull + a.spin.cross(contact.rA) - b.velocity -
                       dt * b.pull - b.spin.cross(contact.rA + bFromA);
        return std::max(contact.gap, 0.0) + dt * u.dot(contact.normal) < 0.0;
    });
}

/// Adds the sleepers that would not learn of a touch by their loads: what bears on nothing yet, and
/// what is touched by a body that it may not move, which has to give way.
void addWhoIsTouched(const World& world, double dt, const GapScratch& scratch,
                     const std::vector<char>& sleeps, std::vector<BodyId>& roots)
{
    std::vector<char> bears(world.bodyCount(), 0);
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (!contact.force.isZero(0.0)) bears[contact.a] = bears[contact.b] = 1;
    }
    for (const std::size_t i : scratch.toAsk) {
        const NearPair& pair = scratch.nearPairs[i];
        const auto [a, b] = pair.bodies;
        if (sleeps[a] == sleeps[b]) continue;
        const BodyId sleeper = sleeps[a] ? a : b, other = sleeps[a] ? b : a;
        const bool mustGiveWay =
            isDriven(scratch.bodies[other]) || isUnmovedBy(world, other, sleeper);
        if (bears[sleeper] && !mustGiveWay) continue;
        if (willTouch(world, dt, scratch, pair)) roots.push_back(sleeper);
    }
}

}  // namespace

void wakeByForces(World& world, const std::vector<AppliedForce>& forces)
{
    std::vector<BodyId> roots;
    for (std::size_t i = 0; i < world.contactMemory.rest.size(); ++i) {
        const BodyRest& rest = world.contactMemory.rest[i];
        const auto body = static_cast<BodyId>(i);
        // A script takes bodies over at the beginning of a frame.
        const bool isTaken = world.info[body].kind == BodyKind::keyed;
        if (rest.isAsleep && (isTaken || !isPulledAsBefore(rest, forces[i]))) roots.push_back(body);
    }
    wakeAround(world, roots);
    if (anyAsleep(world)) wakeWhoIsUneasy(world, forces);
}

bool wakeByTouch(World& world, double dt, const GapScratch& scratch)
{
    if (!anyAsleep(world)) return false;
    std::vector<BodyId> roots;
    const std::vector<char> sleeps = sleepersOf(world);
    addWhoIsLeft(world, scratch, sleeps, roots);
    addWhoIsTouched(world, dt, scratch, sleeps, roots);
    return wakeAround(world, roots);
}

bool wakeStruck(World& world, double dt, const GapScratch& scratch)
{
    if (!anyAsleep(world)) return false;
    // What nothing awake touches lies as the last step has left it.
    const std::vector<BodyId> touched = touchedSleepers(world, scratch);
    const std::vector<ContactLoad> loads = loadsInStep(touched, world, dt, scratch);
    std::vector<BodyId> roots;
    for (const BodyId body : touched) {
        const AppliedForce& other = scratch.forces[body];
        if (isDisturbed(world, body, loads[body], other) &&
            isBlow(world, dt, body, loads[body], other))
            roots.push_back(body);
    }
    return wakeAround(world, roots);
}

void wakeUnbalanced(World& world, const std::vector<AppliedForce>& forces)
{
    if (!anyAsleep(world)) return;
    const ContactMemory& memory = world.contactMemory;
    const std::vector<ContactLoad> loads = loadsOfSleepers(world);
    for (std::size_t i = 0; i < memory.rest.size(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (memory.isAsleep(body) && isDisturbed(world, body, loads[i], forces[i]))
            wake(world, body);
    }
}

}  // namespace scree
