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
        const auto [a, b] = pair.bodies;
        const PassInertia ofA = passInertia(world.mass[a], placed.worldFromA.orientation);
        const PassInertia ofB = passInertia(world.mass[b], placed.worldFromB.orientation);
        const PlacedPair now = placePair(world, pair, world.motion[a].worldFromBody(),
                                         world.motion[b].worldFromBody());
        const bool applied = applyDeepest(world, pair, {placed, now, placed},
                                          {ofA.inverseInertia, ofB.inverseInertia, ofA, ofB},
                                          pair.restitution, settings, dt, touches, counts);
        if (!applied) return;
        predictBody(world, settings, dt, a, scratch);
        predictBody(world, settings, dt, b, scratch);
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
