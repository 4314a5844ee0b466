// What will touch is found at predicted positions, but impulses act where the bodies are now: the
// sample is carried back as a material point of its body. Either half of this rule alone fails:
// ranking by present depth makes a block on an incline creep, predicted points and normals topple a
// stack.  [A39]
#include "core/dynamics/contact_pass.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/dynamics/contact_point.h"

namespace scree {
namespace {

/// How the pairs of a level are worked on in one sweep.
struct Sweep {
    double restitution = 0.0;
    int levelIterations = 1;
    int pairImpulses = 1;
    const std::vector<char>* isFrozen = nullptr;  // per body; null: none
};

struct Tally {
    ImpulseCounts impulses;
    std::int64_t loopsAtTheirCap = 0;
};

void resolvePair(World& world, const StepSettings& settings, double dt, PairRecord& pair,
                 StepScratch& scratch, const Sweep& sweep, Tally& tally)
{
    const auto [a, b] = pair.bodies;
    const auto inertiaOf = [&](BodyId body) {
        const bool isFrozen = sweep.isFrozen && (*sweep.isFrozen)[body];
        return heldIf(isFrozen, scratch.inertia[body]);
    };
    const PairInertia inertia{scratch.inertia[a].inverseInertia, scratch.inertia[b].inverseInertia,
                              heldIf(pair.aIsHeld, inertiaOf(a)),
                              heldIf(pair.bIsHeld, inertiaOf(b))};
    if (!inertia.passA.isMovable() && !inertia.passB.isMovable()) return;
    // Whether a visit has anything to do depends on the motion of the two alone, not on e or on who
    // is frozen.
    if (settings.skipStamps && pair.quiet == stampOf(pair, scratch)) return;

    const PlacedPair now =
        placePair(world, pair, world.motion[a].worldFromBody(), world.motion[b].worldFromBody());
    thread_local std::vector<Touch> touches;
    for (int n = 0; n < sweep.pairImpulses; ++n) {
        touches.clear();
        const PlacedPair predicted =
            placePair(world, pair, scratch.driftPose[a], scratch.driftPose[b]);
        pair.proximity.findTouches(predicted, pair.tau, touches);
        std::sort(touches.begin(), touches.end(), isDeeper);
        const bool applied = applyDeepest(world, settings, pair, {now, now, predicted}, inertia,
                                          sweep.restitution, dt, touches, tally.impulses);
        if (!applied) {
            pair.quiet = stampOf(pair, scratch);
            return;
        }
        noteImpulse(world, settings, dt, pair.bodies, scratch);
    }
    ++tally.loopsAtTheirCap;
}

/// All iterations of one level; islands run at once, each in its own order.
Tally resolveLevel(World& world, const StepSettings& settings, double dt, const ContactLevel& level,
                   StepScratch& scratch, const Sweep& sweep)
{
    std::vector<Tally> tallies(level.islandEnds.size());
    parallelFor(tallies.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t island = begin; island < end; ++island) {
            Tally& tally = tallies[island];
            const std::size_t first = island == 0 ? 0 : level.islandEnds[island - 1];
            for (int l = 0; l < sweep.levelIterations; ++l) {
                const std::int64_t before = tally.impulses.total();
                for (std::size_t place = first; place < level.islandEnds[island]; ++place) {
                    resolvePair(world, settings, dt, scratch.pairs[level.pairs[place]], scratch,
                                sweep, tally);
                }
                if (tally.impulses.total() == before) break;
            }
        }
    });
    Tally sum;
    for (const Tally& tally : tallies) {
        sum.impulses += tally.impulses;
        sum.loopsAtTheirCap += tally.loopsAtTheirCap;
    }
    return sum;
}

void predictAll(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        predictBody(world, settings, dt, static_cast<BodyId>(b), scratch);
    }
}

}  // namespace

ImpulseCounts resolveContacts(World& world, const ContactGraph& graph, const StepSettings& settings,
                              double dt, StepScratch& scratch, std::int64_t& loopsAtTheirCap)
{
    predictAll(world, settings, dt, scratch);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) scratch.pairs[i].quiet = {};
    ImpulseCounts counts;
    for (int k = 1; k <= settings.contactIterations; ++k) {
        const Sweep sweep{-1.0 + static_cast<double>(k) / settings.contactIterations,
                          settings.levelIterations, settings.pairImpulses};
        const std::int64_t before = counts.total();
        for (const ContactLevel& level : graph.contact) {
            const Tally tally = resolveLevel(world, settings, dt, level, scratch, sweep);
            counts += tally.impulses;
            loopsAtTheirCap += tally.loopsAtTheirCap;
        }
        if (counts.total() == before) break;
    }
    return counts;
}

ImpulseCounts propagateShock(World& world, const ContactGraph& graph, const StepSettings& settings,
                             double dt, StepScratch& scratch, std::int64_t& loopsAtTheirCap)
{
    predictAll(world, settings, dt, scratch);
    ImpulseCounts counts;
    std::vector<char> isFrozen(world.bodyCount(), 0);
    const Sweep sweep{0.0, settings.levelIterations, settings.shockPairImpulses, &isFrozen};
    for (const ContactLevel& level : graph.contact) {
        const Tally tally = resolveLevel(world, settings, dt, level, scratch, sweep);
        counts += tally.impulses;
        loopsAtTheirCap += tally.loopsAtTheirCap;
        for (BodyId body : level.supportedBodies) isFrozen[body] = 1;
    }
    return counts;
}

}  // namespace scree
