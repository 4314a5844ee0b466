#include "core/dynamics/gaps/gap_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/sorted.h"
#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/gaps/gap_swings.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Slip and opening of a contact that lasts, as a share of the smaller body: what the solver
/// leaves.
constexpr double kLasting = 1e-6;

/// How much of the motion of a keyed body that turns one may lack that is carried round with it.
constexpr double kCarriedAlong = 1e-3;

/// What a body moves less than with its final velocity when what accelerated it did so for the
/// whole step.
struct MeanMotion {
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();  // [m], [rad]

    MeanMotion(const GapBody& body, double dt)
    {
        if (!body.isMovable() || !body.isStopped) return;
        shift = -0.5 * dt * (body.velocity - body.velocityBefore);
        turn = -0.5 * dt * (body.spin - body.spinBefore);
    }
};

/// Whether a contact is at the end of the step what it was solved to be, also when its surfaces
/// moved by `s` more: one that carries stays closed and one that holds does not slip.
bool lasts(const GapRow& row, const Vec3& s, double gapAtEnd, double blind)
{
    const double apart = s.dot(row.normal);
    if (!row.carries()) return apart >= -blind || gapAtEnd + apart >= 0.0;
    if (std::abs(apart) > blind) return false;
    return !sticks(row) || (s - apart * row.normal).norm() <= blind;
}

/// What the impulses of a pair add to the angular momenta of its bodies, if they are moved
/// [kg m²/s].
struct PairTurn {
    Vec3 ofA = Vec3::Zero(), ofB = Vec3::Zero();
    bool movesA = false, movesB = false;
};

/// Impulses have the lever arms of the beginning of the step, or of the blow they were foreseen to
/// be. A body that moves for a while without one - up to the blow, or by the mean velocity - has
/// its centre elsewhere when it acts, and two that slide along each other meanwhile, by `slid`,
/// would gain or lose angular momentum. They take the couple that is missing, as if the place had
/// gone along with both: each the more of it the harder it is to turn. Half each let a block sink
/// under ten thousand times its weight.
void addCouple(World& world, const GapScratch& scratch, const GapRow& row, const Vec3& impulse,
               const Vec3& slid)
{
    if (!row.movesA || !row.movesB) return;
    const double easeA = easeOfTurning(scratch.bodies[row.a], row.movesA);
    const double easeB = easeOfTurning(scratch.bodies[row.b], row.movesB);
    const Vec3 couple = impulse.cross(slid) / (easeA + easeB);
    world.motion[row.a].angularMomentum += easeB * couple;
    world.motion[row.b].angularMomentum += easeA * couple;
}

/// Balls that are struck twice in a step are not where their blows found them, and nothing that
/// goes through their centres turns them: of a couple for that, 27 elastic balls without friction
/// gained a third of their energy in fifteen seconds, and those of a break left with a spin.
void addCouplesOfImpacts(World& world, const GapScratch& scratch)
{
    for (const GapImpact& impact : scratch.impacts) {
        const GapRow& row = scratch.rows[impact.row];
        const GapBody& a = scratch.bodies[row.a];
        const GapBody& b = scratch.bodies[row.b];
        // With the shifts: as far as they came before any blow of the step.
        addCouple(world, scratch, row, impact.impulse - impact.central,
                  a.hitAt * a.velocity + a.shift - b.hitAt * b.velocity - b.shift - impact.slid);
    }
}

/// Whether a body moves as if it were a part of one that turns.
bool isCarriedRound(const GapBody& body, const GapBody& keyed, const Vec3& fromKeyed)
{
    const Vec3 round = keyed.spin.cross(fromKeyed);
    return (body.velocity - keyed.velocity - round).norm() <= kCarriedAlong * round.norm() &&
           (body.spin - keyed.spin).norm() <= kCarriedAlong * keyed.spin.norm();
}

/// What a keyed body carries round with it goes on its arc, not on the tangent of that: boxes on a
/// turntable had crept outward by 3 % of their radius a turn. So does what lies on these.
void goRoundWithKeyed(const World& world, double dt, const GapIsland& island, GapScratch& scratch)
{
    std::vector<BodyId> turning;
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
            const GapBody& b = scratch.bodies[body];
            if (pair.bearing > 0 && isDriven(b) && !b.spin.isZero(0.0)) turning.push_back(body);
        }
    }
    if (turning.empty()) return;
    sortUnique(turning);
    for (const BodyId mover : island.movers) {
        GapBody& body = scratch.bodies[mover];
        for (const BodyId id : turning) {
            const GapBody& keyed = scratch.bodies[id];
            const Vec3 from = world.motion[mover].position - world.motion[id].position;
            if (!isCarriedRound(body, keyed, from)) continue;
            const Vec3 turn = dt * keyed.spin;
            body.shift += exponentialMap(turn) * from - from - turn.cross(from);
            break;
        }
    }
}

/// Whether all contacts of an island last through a step of mean motion.
bool lasts(const World& world, double dt, const GapScratch& scratch, const GapIsland& island)
{
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        const auto [idA, idB] = pair.bodies;
        if (world.contactMemory.isAsleep(idA) || world.contactMemory.isAsleep(idB)) return false;
        const GapBody& a = scratch.bodies[idA];
        const GapBody& b = scratch.bodies[idB];
        const MeanMotion ofA(a, dt), ofB(b, dt);
        const double blind = kLasting * smallerRadius(world, idA, idB);
        for (const GapRow& row : scratch.rowsOf(pair)) {
            if (row.carries() && (isDriven(a) || isDriven(b))) return false;
            const Vec3 s = ofA.shift + ofA.turn.cross(row.rA) - ofB.shift - ofB.turn.cross(row.rB);
            const double gapAtEnd =
                row.gap + shiftAt(row, a, b) + dt * velocityAt(row, a, b).dot(row.normal);
            if (!lasts(row, s, gapAtEnd, blind)) return false;
        }
    }
    return true;
}

/// Whether a carrying row of an island does what is asked.
template <class Asked>
bool carriesAny(const GapScratch& scratch, const GapIsland& island, const Asked& asked)
{
    return std::ranges::any_of(island.pairs, [&](std::size_t i) {
        return std::ranges::any_of(scratch.rowsOf(scratch.pairs[i]),
                                   [&](const GapRow& row) { return row.carries() && asked(row); });
    });
}

/// Gives back half of what has accelerated a body: its velocities are those of the middle of the
/// step then, and move it as their mean would.
void endInTheMiddle(GapBody& body, BodyMotion& motion)
{
    const Vec3 dv = 0.5 * (body.velocity - body.velocityBefore);
    const Vec3 dw = 0.5 * (body.spin - body.spinBefore);
    body.velocity -= dv;
    body.spin -= dw;
    motion.velocity -= dv;
    motion.angularMomentum -= body.inverseInertia.inverse() * dw;
}

/// End-of-step velocities are what contacts need, and move what speeds up or slows down by half a
/// step's change too far. Where all contacts of an island last, its bodies move by the mean of the
/// velocities before and after instead, as in free flight. What a keyed body carries it carries
/// along: its velocity is the mean of the step already. Nor beside a sleeper: there a heap comes to
/// rest, and what the other way damps is what rocks in it.
///
/// Nor what swings (gap_swings.h): its velocities are those of the middle of a step, as of any
/// method that steps so. Who took the one for the other gained energy each time: half a cylinder,
/// which moved by the mean where it rocked to and fro slowly, rocked two and a half times as high
/// after two minutes, a ring on a peg 1.6 times as wide after five. What begins to swing goes over
/// to velocities of the middle, and so begins when it should.
void moveByTheMean(World& world, double dt, GapScratch& scratch)
{
    const auto late = [dt](const GapBody& body) {
        return body.isStopped ? Vec3(0.5 * dt * body.velocity) : Vec3(Vec3::Zero());
    };
    forEach(scratch.islands.size(), 1, [&](std::size_t i) {
        const GapIsland& island = scratch.islands[i];
        if (!lasts(world, dt, scratch, island)) return;
        if (carriesAny(scratch, island, [](const GapRow& row) { return row.swings; })) return;
        const bool mayBegin =
            !isHeap(island) && std::ranges::all_of(island.movers, [&](BodyId mover) {
                return scratch.bodies[mover].isStopped;
            });
        if (mayBegin && carriesAny(scratch, island, [&](const GapRow& row) {
                return beginsToSwing(world, scratch, row);
            })) {
            for (const BodyId mover : island.movers)
                endInTheMiddle(scratch.bodies[mover], world.motion[mover]);
            return;
        }
        for (const std::size_t p : island.pairs) {
            for (const GapRow& row : scratch.rowsOf(scratch.pairs[p])) {
                if (!row.carries()) continue;
                addCouple(world, scratch, row, row.worldImpulse(),
                          late(scratch.bodies[row.a]) - late(scratch.bodies[row.b]));
            }
        }
        for (const BodyId mover : island.movers) {
            GapBody& body = scratch.bodies[mover];
            const MeanMotion mean(body, dt);
            body.shift += mean.shift;
            body.turn += mean.turn;
        }
    });
}

/// Lays out what the world will remember: the contacts of the pairs, yet to be filled in, and among
/// them those that hold sleepers as they did, for when these wake. The old memory is sorted, and so
/// are the pairs. Answers where the contacts of each pair begin.
std::vector<std::size_t> layOutMemory(const World& world, GapScratch& scratch)
{
    std::vector<RememberedContact>& kept = scratch.formerContacts;
    std::size_t end = 0;
    const auto makeRoom = [&](std::size_t count) {
        if (kept.size() < end + count) kept.resize(end + count);
    };
    std::vector<std::size_t> first(scratch.pairs.size());
    std::size_t next = 0;
    const auto placePair = [&] {
        first[next] = end;
        makeRoom(scratch.pairs[next].bearing);
        end += scratch.pairs[next++].bearing;
    };
    const auto isStepped = [&](BodyId body) { return scratch.bodies[body].isMovable(); };
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        const bool sleeps =
            world.contactMemory.isAsleep(contact.a) || world.contactMemory.isAsleep(contact.b);
        if (!sleeps || isStepped(contact.a) || isStepped(contact.b)) continue;
        while (next < first.size() && scratch.pairs[next].bodies < bodiesOf(contact)) placePair();
        makeRoom(1);
        kept[end++] = contact;
    }
    while (next < first.size()) placePair();
    kept.resize(end);
    return first;
}

/// Fills the contacts of a pair in, from `place` on, and answers what they add to its bodies.
PairTurn rememberContacts(const World& world, double dt, GapScratch& scratch, const GapPair& pair,
                          std::size_t place)
{
    PairTurn turn;
    const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
    const Quat aFromWorld = world.motion[pair.bodies.a].orientation.conjugate();
    for (std::size_t r = pair.begin; r < pair.end; ++r) {
        const GapRow& row = scratch.rows[r];
        if (!row.carries()) continue;
        turn.movesA = row.movesA;
        turn.movesB = row.movesB;
        const Vec3 impulse = row.worldImpulse();
        // What changes the angular momentum is the impulse itself: a product with an inertia and
        // its inverse would lose bits every step.
        turn.ofA += row.rA.cross(impulse) + row.couple;
        turn.ofB -= row.rB.cross(impulse) + row.couple;
        scratch.formerContacts[place++] = {
            row.a,        row.b,          contacts[r - pair.begin].feature, aFromWorld * row.rA,
            impulse / dt, row.couple / dt};
    }
    turn.ofA /= scratch.bodies[pair.bodies.a].heavier;
    turn.ofB /= scratch.bodies[pair.bodies.b].heavier;
    return turn;
}

/// What blows have given a body [kg m²/s].
Vec3 struckWith(double dt, const GapBody& body)
{
    return body.angularImpulse - dt * body.torque;
}

/// A body that is struck turns until then as it did: forth with the angular momentum it had, and
/// back with that it has now, so that the whole step with this ends where it should. By rotation
/// vectors alone a slab that tumbled over the ground for ten seconds lost a twentieth of its
/// energy.
void turnUntilBlow(const StepSettings& settings, double dt, const GapBody& body,
                   const BodyMass& mass, BodyMotion& motion)
{
    const auto turn = [&](const Vec3& angularMomentum, double time) {
        motion.orientation =
            predictPose(motion, mass, motion.velocity, angularMomentum, settings.orientation, time)
                .orientation;
    };
    turn(motion.angularMomentum - struckWith(dt, body), body.hitAt);
    turn(motion.angularMomentum, -body.hitAt);
}

}  // namespace

void writeVelocities(World& world, double dt, GapScratch& scratch)
{
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        if (!scratch.bodies[i].isMovable()) return;
        world.motion[i].velocity = scratch.bodies[i].velocity;
        world.motion[i].angularMomentum += scratch.bodies[i].angularImpulse;
    });
    const std::vector<std::size_t> first = layOutMemory(world, scratch);
    std::vector<PairTurn> turns(scratch.pairs.size());
    forPairs(scratch, [&](std::size_t i) {
        fetchContactsAfter(scratch, i);
        if (i + kPairsAhead < scratch.pairs.size())
            fetchRows(world, scratch, scratch.pairs[i + kPairsAhead]);
        const GapPair& pair = scratch.pairs[i];
        if (pair.bearing > 0) turns[i] = rememberContacts(world, dt, scratch, pair, first[i]);
    });
    for (std::size_t i = 0; i < scratch.pairs.size(); ++i) {
        const auto [a, b] = scratch.pairs[i].bodies;
        if (turns[i].movesA) world.motion[a].angularMomentum += turns[i].ofA;
        if (turns[i].movesB) world.motion[b].angularMomentum += turns[i].ofB;
    }
    std::swap(world.contactMemory.contacts, scratch.formerContacts);
    world.contactMemory.dt = dt;
}

void moveBodies(World& world, const StepSettings& settings, double dt, GapScratch& scratch)
{
    addCouplesOfImpacts(world, scratch);
    moveByTheMean(world, dt, scratch);
    forEach(scratch.islands.size(), 1,
            [&](std::size_t i) { goRoundWithKeyed(world, dt, scratch.islands[i], scratch); });
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const GapBody& body = scratch.bodies[i];
        if (body.hitAt > 0.0) turnUntilBlow(settings, dt, body, world.mass[i], world.motion[i]);
    });
    advancePositions(world, settings, dt);
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        BodyMotion& motion = world.motion[i];
        GapBody& body = scratch.bodies[i];
        if (body.isMovable()) {
            motion.position += body.shift;
            Vec3 turn = body.turn;
            if (body.hitAt > 0.0) turn += body.hitAt * (body.inverseInertia * struckWith(dt, body));
            motion.orientation = rotated(motion.orientation, turn);
        }
        // From here on the shift is the whole displacement: what the rows need for their gaps.
        body.shift += dt * motion.velocity;
        body.turn += dt * body.spin;
    });
}

}  // namespace scree
