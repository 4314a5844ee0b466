// Each iteration moves all bodies to where they would be after the step, gravity included, and
// finds the pairs that interfere there. Geometry (point, normal, K) is that of the impact,
// velocities are the present ones. A block at rest is therefore never mistaken for one that just
// landed.
//
// In a heap at rest all bodies fall together, so its upper pairs do not interfere at common
// predicted positions. The last iteration also takes the pairs of which one body, falling alone,
// meets the other: no pair may be treated inelastically by contact that has not had its chance to
// bounce.  [A26]
#include "core/dynamics/collision_pass.h"

#include "core/base/parallel.h"
#include "core/dynamics/contact_point.h"

namespace scree {
namespace {

/// Which prediction places the two bodies while their pair is processed.
enum class Placing { bothFall, aFalls, bFalls };

PlacedPair place(const World& world, const PairRecord& pair, const StepScratch& scratch,
                 Placing placing)
{
    const auto [a, b] = pair.bodies;
    return placePair(world, pair,
                     placing == Placing::bFalls ? scratch.driftPose[a] : scratch.fallPose[a],
                     placing == Placing::aFalls ? scratch.driftPose[b] : scratch.fallPose[b]);
}

/// Where a pair is worked on in a visit by collision, and with what.
struct CollisionVisit {
    PlacedPair placed, now;
    PairInertia inertia;
};

CollisionVisit beginVisit(const World& world, const PairRecord& pair, const StepScratch& scratch,
                          Placing placing)
{
    const auto [a, b] = pair.bodies;
    const PlacedPair placed = place(world, pair, scratch, placing);
    // The angular momentum of a keyed body was made from its spin where it is now.  [A54]
    const auto inertiaOf = [&](BodyId body, const Quat& predicted) {
        const bool isKeyed = world.info[body].kind == BodyKind::keyed;
        return passInertia(world.mass[body], isKeyed ? world.motion[body].orientation : predicted);
    };
    const PassInertia ofA = inertiaOf(a, placed.worldFromA.orientation);
    const PassInertia ofB = inertiaOf(b, placed.worldFromB.orientation);
    return {placed,
            placePair(world, pair.bodies),
            {ofA.inverseInertia, ofB.inverseInertia, fixedIf(pair.aIsUnmoved, ofA),
             fixedIf(pair.bIsUnmoved, ofB)}};
}

/// Impulses at contacts found once: whichever is deepest among those that still approach, until
/// each has been seen to separate. One that separates is dropped for good.  [A25]
void resolveLagged(World& world, const StepSettings& settings, double dt, PairRecord& pair,
                   StepScratch& scratch, Placing placing, PassTally& tally)
{
    constexpr std::size_t kImpulsesPerSample = 10;
    const CollisionVisit visit = beginVisit(world, pair, scratch, placing);
    std::vector<Touch> touches;
    pair.proximity.findTouches(visit.placed, pair.tau, touches);
    const ContactFrames frames{visit.placed, visit.now, visit.placed};
    std::vector<ContactPoint> contacts;
    for (const Touch& touch : touches) {
        contacts.push_back(placeContact(world, pair, touch, frames, visit.inertia.ownInverseA,
                                        visit.inertia.ownInverseB, settings));
    }
    const double slowest = slowestApproach(settings, dt);
    const auto separates = [&](ContactPoint& contact) {
        updateApproach(world, pair, visit.inertia, contact);
        return contact.u.dot(contact.normal) >= -slowest;
    };
    std::size_t left = kImpulsesPerSample * contacts.size();
    bool isMoved = false;
    while (true) {
        std::erase_if(contacts, separates);
        if (contacts.empty()) break;
        if (left-- == 0) {
            ++tally.loopsAtTheirCap;
            break;
        }
        applyContact(world, settings, pair, contacts.front(), frames, visit.inertia,
                     pair.restitution, tally.impulses);
        isMoved = true;
    }
    if (isMoved) predictAfterImpulse(world, settings, dt, pair.bodies, scratch);
}

/// Re-evolves the pair after every impulse until nothing is both interfering and approaching. [A24]
void resolveReevolving(World& world, const StepSettings& settings, double dt, PairRecord& pair,
                       StepScratch& scratch, Placing placing, PassTally& tally)
{
    for (int n = 0; n < settings.collisionPairImpulses; ++n) {
        const CollisionVisit visit = beginVisit(world, pair, scratch, placing);
        pair.proximity.place(visit.placed, pair.tau);
        const bool applied =
            applyDeepest(world, settings, pair, {visit.placed, visit.now, visit.placed},
                         visit.inertia, pair.restitution, dt, tally.impulses);
        if (!applied) return;
        predictAfterImpulse(world, settings, dt, pair.bodies, scratch);
    }
    ++tally.loopsAtTheirCap;
}

void resolvePair(World& world, const StepSettings& settings, double dt, PairRecord& pair,
                 StepScratch& scratch, Placing placing, PassTally& tally)
{
    const bool isLagged = settings.collision == CollisionVariant::lagged;
    (isLagged ? resolveLagged : resolveReevolving)(world, settings, dt, pair, scratch, placing,
                                                   tally);
}

void findInterference(const World& world, const StepSettings& settings, StepScratch& scratch)
{
    parallelFor(scratch.pairCount, kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PairRecord& pair = scratch.pairs[i];
            if (settings.skipStamps && pair.searched == stampOf(pair, scratch)) continue;
            pair.searched = stampOf(pair, scratch);
            pair.interferesNow =
                pair.proximity.interferes(place(world, pair, scratch, Placing::bothFall), pair.tau);
            pair.isTouched = pair.isTouched || pair.interferesNow;
        }
    });
}

void findLoneFalls(const World& world, StepScratch& scratch)
{
    parallelFor(scratch.pairCount, kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PairRecord& pair = scratch.pairs[i];
            const auto meets = [&](Placing placing) {
                return pair.proximity.interferes(place(world, pair, scratch, placing), pair.tau);
            };
            pair.aFallsOnB = world.mass[pair.bodies.a].isMovable() && meets(Placing::aFalls);
            pair.bFallsOnA = world.mass[pair.bodies.b].isMovable() && meets(Placing::bFalls);
            pair.isTouched = pair.isTouched || pair.aFallsOnB || pair.bFallsOnA;
        }
    });
}

/// All visits of one iteration: pairs that interfere with both bodies falling, else those that do
/// with one.
PassTally resolveInterfering(World& world, const StepSettings& settings, double dt,
                             StepScratch& scratch, bool withLoneFalls)
{
    std::vector<PairVisit> visits;
    for (const std::size_t i : scratch.pairOrder) {
        const PairRecord& pair = scratch.pairs[i];
        const bool falls = withLoneFalls && (pair.aFallsOnB || pair.bFallsOnA);
        if (pair.interferesNow || falls) visits.push_back({i});
    }
    const WorkOrder order = orderOf(world, scratch, visits);
    return visitPairs<PassTally>(
        visits, order, scratch, [&](const PairVisit&, PairRecord& pair, PassTally& tally) {
            const auto resolve = [&](Placing placing) {
                resolvePair(world, settings, dt, pair, scratch, placing, tally);
            };
            if (pair.interferesNow) return resolve(Placing::bothFall);
            if (pair.aFallsOnB) resolve(Placing::aFalls);
            if (pair.bFallsOnA) resolve(Placing::bFalls);
        });
}

}  // namespace

PassTally resolveCollisions(World& world, const StepSettings& settings, double dt,
                            StepScratch& scratch)
{
    PassTally sum;
    for (int iteration = 1; iteration < settings.collisionIterations; ++iteration) {
        widenPairs(world, settings, dt, scratch);
        findInterference(world, settings, scratch);
        const PassTally tally = resolveInterfering(world, settings, dt, scratch, false);
        sum += tally;
        if (tally.impulses.total() == 0) break;
    }

    widenPairs(world, settings, dt, scratch);
    findInterference(world, settings, scratch);
    findLoneFalls(world, scratch);
    // Switched off, collisions are still found: contact wants to know them.
    if (settings.collisionIterations > 0)
        sum += resolveInterfering(world, settings, dt, scratch, true);
    return sum;
}

}  // namespace scree
