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

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/contact_point.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/integrator.h"

namespace scree {
namespace {

constexpr std::size_t kPairGrain = 16;

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

/// The deepest interference that is approaching; applies its impulse. False when there is none.
bool applyDeepest(World& world, const StepSettings& settings, double dt, const PairRecord& pair,
                  const PlacedPair& placed, const std::vector<Touch>& deepestFirst,
                  ImpulseCounts& counts)
{
    const auto [a, b] = pair.bodies;
    const double slowest = 1e-10 * settings.gravity.norm() * dt + 1e-15;  // [A29]
    const PassInertia inertiaA = passInertia(world.mass[a], placed.worldFromA.orientation);
    const PassInertia inertiaB = passInertia(world.mass[b], placed.worldFromB.orientation);
    const PlacedPair now =
        placePair(world, pair, world.motion[a].worldFromBody(), world.motion[b].worldFromBody());
    for (const Touch& touch : deepestFirst) {
        const ContactPoint contact = placeContact(world, pair, touch, {placed, now, placed},
                                                  inertiaA.inverseInertia, inertiaB.inverseInertia);
        if (contact.u.dot(contact.normal) >= -slowest) continue;
        const PassInertia& inertiaS = touch.sampleOnA ? inertiaA : inertiaB;
        const PassInertia& inertiaF = touch.sampleOnA ? inertiaB : inertiaA;
        const Mat3 k =
            collisionMatrix(inertiaS, contact.rS) + collisionMatrix(inertiaF, contact.rF);
        const ContactImpulse j =
            contactImpulse(k, contact.u, contact.normal, pair.restitution, pair.friction);
        applyImpulse(world.motion[contact.sampleBody], inertiaS, contact.rS, j.impulse);
        applyImpulse(world.motion[contact.fieldBody], inertiaF, contact.rF, -j.impulse);
        countImpulse(counts, j.kind);
        return true;
    }
    return false;
}

/// Re-evolves the pair after every impulse until nothing is both interfering and approaching. [A24]
void resolvePair(World& world, const StepSettings& settings, double dt, PairRecord& pair,
                 StepScratch& scratch, Placing placing, ImpulseCounts& counts,
                 std::int64_t& loopsAtTheirCap)
{
    std::vector<Touch> touches;
    for (int n = 0; n < settings.collisionPairImpulses; ++n) {
        const PlacedPair placed = place(world, pair, scratch, placing);
        touches.clear();
        pair.proximity.findTouches(placed, pair.tau, touches);
        std::sort(touches.begin(), touches.end(), isDeeper);
        if (!applyDeepest(world, settings, dt, pair, placed, touches, counts)) return;
        predictBody(world, settings, dt, pair.bodies.a, scratch);
        predictBody(world, settings, dt, pair.bodies.b, scratch);
    }
    ++loopsAtTheirCap;
}

void findInterference(const World& world, StepScratch& scratch)
{
    parallelFor(scratch.pairCount, kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PairRecord& pair = scratch.pairs[i];
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

}  // namespace

ImpulseCounts resolveCollisions(World& world, const StepSettings& settings, double dt,
                                StepScratch& scratch, std::int64_t& loopsAtTheirCap)
{
    ImpulseCounts counts;
    for (int iteration = 1; iteration < settings.collisionIterations; ++iteration) {
        widenPairs(world, settings, dt, scratch);
        findInterference(world, scratch);
        const std::int64_t before = counts.total();
        for (std::size_t i : scratch.pairOrder) {
            PairRecord& pair = scratch.pairs[i];
            if (!pair.interferesNow) continue;
            resolvePair(world, settings, dt, pair, scratch, Placing::bothFall, counts,
                        loopsAtTheirCap);
        }
        if (counts.total() == before) break;
    }

    widenPairs(world, settings, dt, scratch);
    findInterference(world, scratch);
    findLoneFalls(world, scratch);
    for (std::size_t i : scratch.pairOrder) {
        PairRecord& pair = scratch.pairs[i];
        if (pair.interferesNow) {
            resolvePair(world, settings, dt, pair, scratch, Placing::bothFall, counts,
                        loopsAtTheirCap);
            continue;
        }
        if (pair.aFallsOnB) {
            resolvePair(world, settings, dt, pair, scratch, Placing::aFalls, counts,
                        loopsAtTheirCap);
        }
        if (pair.bFallsOnA) {
            resolvePair(world, settings, dt, pair, scratch, Placing::bFalls, counts,
                        loopsAtTheirCap);
        }
    }
    return counts;
}

}  // namespace scree
