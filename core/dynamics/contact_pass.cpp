// What will touch is found at predicted positions, but impulses act where the bodies are now: the
// sample is carried back as a material point of its body. Either half of this rule alone fails:
// ranking by present depth makes a block on an incline creep, predicted points and normals topple a
// stack.  [A39]
#include "core/dynamics/contact_pass.h"

#include "core/dynamics/contact_point.h"

namespace scree {
namespace {

/// How pairs are worked on in one sweep.
struct Sweep {
    double restitution = 0.0;
    int pairImpulses = 1;
    const FrozenBodies* frozen = nullptr;  // null: none
};

void resolvePair(World& world, const StepSettings& settings, double dt, int level, PairRecord& pair,
                 StepScratch& scratch, const Sweep& sweep, PassTally& tally)
{
    const auto [a, b] = pair.bodies;
    const auto inertiaOf = [&](BodyId body) {
        const bool isFrozen = sweep.frozen && sweep.frozen->isFrozen(body, level);
        return fixedIf(isFrozen, scratch.inertia[body]);
    };
    const PairInertia inertia{scratch.inertia[a].inverseInertia, scratch.inertia[b].inverseInertia,
                              fixedIf(pair.aIsUnmoved, inertiaOf(a)),
                              fixedIf(pair.bIsUnmoved, inertiaOf(b))};
    if (!inertia.passA.isMovable() && !inertia.passB.isMovable()) return;
    // Whether a visit has anything to do depends on the motion of the two alone, not on e or on who
    // is frozen.
    if (settings.skipStamps && pair.quiet == stampOf(pair, scratch)) return;

    const PlacedPair now = placePair(world, pair.bodies);
    for (int n = 0; n < sweep.pairImpulses; ++n) {
        const PlacedPair predicted =
            placePair(world, pair, scratch.driftPose[a], scratch.driftPose[b]);
        pair.proximity.place(predicted, pair.tau);
        const bool applied = applyDeepest(world, settings, pair, {now, now, predicted}, inertia,
                                          sweep.restitution, dt, tally.impulses);
        if (!applied) {
            pair.quiet = stampOf(pair, scratch);
            return;
        }
        predictAfterImpulse(world, settings, dt, pair.bodies, scratch);
    }
    ++tally.loopsAtTheirCap;
}

void predictAll(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        predictBody(world, settings, dt, static_cast<BodyId>(b), scratch);
    }
}

}  // namespace

PassTally resolveContacts(World& world, const ContactGraph& graph, const StepSettings& settings,
                          double dt, StepScratch& scratch)
{
    predictAll(world, settings, dt, scratch);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) scratch.pairs[i].quiet = {};
    const std::vector<PairVisit> visits = visitsUpward(graph.contact, settings.levelIterations);
    const WorkOrder order = orderOf(world, scratch, visits);
    PassTally sum;
    for (int k = 1; k <= settings.contactIterations; ++k) {
        const Sweep sweep{-1.0 + static_cast<double>(k) / settings.contactIterations,
                          settings.pairImpulses};
        const PassTally tally = visitPairs<PassTally>(
            visits, order, scratch,
            [&](const PairVisit& visit, PairRecord& pair, PassTally& ofVisit) {
                resolvePair(world, settings, dt, visit.level, pair, scratch, sweep, ofVisit);
            });
        sum += tally;
        if (tally.impulses.total() == 0) break;
    }
    return sum;
}

PassTally propagateShock(World& world, const ContactGraph& graph, const StepSettings& settings,
                         double dt, StepScratch& scratch)
{
    predictAll(world, settings, dt, scratch);
    const FrozenBodies frozen(graph.contact, world.bodyCount());
    const Sweep sweep{0.0, settings.shockPairImpulses, &frozen};
    const std::vector<PairVisit> visits = visitsUpward(graph.contact, settings.levelIterations);
    return visitPairs<PassTally>(visits, orderOf(world, scratch, visits), scratch,
                                 [&](const PairVisit& visit, PairRecord& pair, PassTally& ofVisit) {
                                     resolvePair(world, settings, dt, visit.level, pair, scratch,
                                                 sweep, ofVisit);
                                 });
}

}  // namespace scree
