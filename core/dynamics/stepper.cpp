// Two methods share the loop over a frame. stepFoundPairs is the paper's step, phase by phase
// [GBF03 “Time Integration”]. stepGaps is the same pipeline on contacts that are known before they
// touch: a step is laid out and solved, in the scratch alone, until nobody is woken by it nor runs
// into what was not looked at; then everything moves at once.
#include "core/dynamics/stepper.h"

#include <algorithm>
#include <utility>

#include "core/base/random.h"
#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/births.h"
#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/gap_blocks.h"
#include "core/dynamics/gap_bounce.h"
#include "core/dynamics/gap_contact.h"
#include "core/dynamics/gap_forces.h"
#include "core/dynamics/gap_foresight.h"
#include "core/dynamics/gap_kept.h"
#include "core/dynamics/gap_laden.h"
#include "core/dynamics/gap_lag.h"
#include "core/dynamics/gap_layout.h"
#include "core/dynamics/gap_lead.h"
#include "core/dynamics/gap_levels.h"
#include "core/dynamics/gap_motion.h"
#include "core/dynamics/gap_overrun.h"
#include "core/dynamics/gap_press.h"
#include "core/dynamics/gap_push_out.h"
#include "core/dynamics/gap_riders.h"
#include "core/dynamics/gap_shock.h"
#include "core/dynamics/gap_swings.h"
#include "core/dynamics/gap_unseen.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/push_out.h"
#include "core/dynamics/scratch.h"
#include "core/dynamics/sleep.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/step_limit.h"
#include "core/dynamics/step_view.h"
#include "core/dynamics/waking.h"

namespace scree {
namespace {

/// How often a step of method `scree` is solved again because something was struck so that it ran
/// into what nobody had looked at.
constexpr int kMostLooks = 64;

/// As many swaps as there are bodies, each drawn for this very step: no draw depends on those
/// before it, so a resumed run draws the same. Method `scree` goes up and down the levels in a
/// fixed order instead: what remembers its impulses gains nothing by other orders.  [A21]
void shuffleOrder(World& world, std::uint64_t seed)
{
    const std::uint64_t count = world.order.size();
    const auto frame = static_cast<std::uint64_t>(world.clock.frame);
    const auto subStep = static_cast<std::uint64_t>(world.clock.subStep);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t p = randomIndex(count, seed, frame, subStep, 2 * i);
        const std::uint64_t q = randomIndex(count, seed, frame, subStep, 2 * i + 1);
        std::swap(world.order[p], world.order[q]);
    }
}

}  // namespace

Stepper::Stepper(const StepSettings& settings)
    : settings_(settings),
      scratch_(std::make_unique<StepScratch>()),
      gaps_(std::make_unique<GapScratch>())
{
}

Stepper::~Stepper() = default;

StepReport Stepper::step(World& world, double dt)
{
    world.assignKinds();
    if (settings_.method == Method::scree) return stepGaps(world, dt);
    findPairs(world, settings_, dt, *scratch_);
    return stepFoundPairs(world, dt);
}

StepReport Stepper::stepFoundPairs(World& world, double dt)
{
    StepReport report;
    report.dt = dt;
    StepScratch& scratch = *scratch_;
    const auto timed = [&report](Phase phase, const auto& work) {
        const PhaseTimer timer(report.seconds, phase);
        return work();
    };
    const auto note = [&report](const PassTally& tally, ImpulseCounts& impulses) {
        impulses = tally.impulses;
        report.loopsAtTheirCap += tally.loopsAtTheirCap;
    };
    // What is no number spreads to all it touches: no phase goes on with it.
    const auto isBroken = [&](Phase phase) {
        findNonFinite(world, phase, report);
        return !report.nonFinite.empty();
    };
    aimKeyedBodies(world, dt);
    scratch.isWatched = observer_ != nullptr;
    shuffleOrder(world, settings_.seed);
    beginStep(world, settings_, dt, scratch);

    // Collisions are found at predicted positions but change velocities that have not yet felt
    // gravity. A block at rest is therefore never mistaken for one that just landed.
    note(timed(Phase::collision, [&] { return resolveCollisions(world, settings_, dt, scratch); }),
         report.collisionImpulses);
    if (isBroken(Phase::collision)) return report;
    const ContactGraph graph = timed(
        Phase::contactGraph, [&] { return buildContactGraph(world, settings_, dt, scratch); });
    addForces(world, scratch.forces, dt);
    note(timed(Phase::contact,
               [&] { return resolveContacts(world, graph, settings_, dt, scratch); }),
         report.contactImpulses);
    if (isBroken(Phase::contact)) return report;
    if (settings_.shockPropagation) {
        note(timed(Phase::shock,
                   [&] { return propagateShock(world, graph, settings_, dt, scratch); }),
             report.shockImpulses);
    }
    if (isBroken(Phase::shock)) return report;
    timed(Phase::position, [&] { advancePositions(world, settings_, dt); });
    if (isBroken(Phase::position)) return report;
    timed(Phase::pushOut, [&] { separateFoundPairs(world, graph, report); });
    findNonFinite(world, Phase::pushOut, report);

    describeGraph(graph, scratch, report);
    if (observer_) observer_->stepDone(seePairs(scratch, graph.levels, dt));
    ++world.clock.subStep;
    return report;
}

/// Push-out, and what it found and left.
void Stepper::separateFoundPairs(World& world, const ContactGraph& graph, StepReport& report)
{
    StepScratch& scratch = *scratch_;
    report.deepestBeforePushOut = findWorstOverlap(world, scratch).depth;
    const double before = potentialEnergy(world, settings_.gravity);
    if (settings_.pushOut) {
        const PushOutTally tally = separateOverlaps(world, graph, settings_, scratch);
        report.pushes = tally.pushes;
        report.pushesCut = tally.cut;
    }
    report.pushOutWork = potentialEnergy(world, settings_.gravity) - before;
    describeOverlap(findWorstOverlap(world, scratch), report);
}

/// New velocities for the bodies of a block, in the scratch alone. Answers the time each phase took
/// [s].
PhaseSeconds Stepper::solveBlock(const World& world, double dt, GapBlock& block)
{
    GapScratch& scratch = *gaps_;
    PhaseSeconds seconds{};
    {
        const PhaseTimer timer(seconds, Phase::contactGraph);
        buildRows(world, settings_, dt, block, scratch);
        gripSqueezed(world, settings_, dt, block, scratch);
    }
    // Impacts change velocities that have not yet felt gravity, as in the paper: what lies still is
    // never mistaken for what has just landed.
    {
        const PhaseTimer timer(seconds, Phase::collision);
        const std::vector<Held>& held = heldAsBefore(dt, block, scratch);
        foreseeBlows(world, settings_, dt, held, block, scratch);
        const std::vector<VelocityLead> trails = trailPlaces(world, block, scratch);
        resolveImpacts(settings_, dt, held, block, scratch);
        endOverruns(world, dt, block, scratch);
        forgetMomentsOfBlows(world, block, scratch);
        takeBack(trails, scratch);
        findLevels(dt, block, scratch);
    }
    std::vector<VelocityLead> leads;
    {
        const PhaseTimer timer(seconds, Phase::contact);
        leads = leadPlaces(world, dt, block, scratch);
        addForcesToGaps(dt, block, scratch);
        holdSwings(world, settings_, dt, block, scratch);
    }
    LadenBodies laden(settings_, dt, block, scratch);
    {
        const PhaseTimer timer(seconds, Phase::contact);
        resolveGaps(world, settings_, dt, block, scratch);
    }
    if (settings_.shockPropagation) {
        const PhaseTimer timer(seconds, Phase::shock);
        propagateShockUp(world, settings_, dt, block, scratch);
    }
    laden.release();
    takeBack(leads, scratch);
    return seconds;
}

/// New velocities, in the scratch alone: the world is as it was. `solved`: by an earlier attempt.
void Stepper::solveGaps(World& world, double dt, const SolvedIslands& solved, StepReport& report)
{
    GapScratch& scratch = *gaps_;
    {
        const PhaseTimer timer(report.seconds, Phase::contactGraph);
        layOutGaps(world, settings_, dt, solved, scratch);
        addForcesToOthers(dt, scratch);
    }
    std::vector<PhaseSeconds> ofBlocks(scratch.blocks.size());
    const Stopwatch watch;
    forBlocks(scratch, [&](GapBlock& block) {
        ofBlocks[&block - scratch.blocks.data()] = solveBlock(world, dt, block);
    });
    addShares(watch.seconds(), ofBlocks, report.seconds);
    for (const GapBlock& block : scratch.blocks) {
        scratch.impacts.insert(scratch.impacts.end(), block.impacts.begin(), block.impacts.end());
    }
    report.loopsAtTheirCap += std::ranges::any_of(scratch.blocks, &GapBlock::isAtItsCap);
}

StepReport Stepper::stepGaps(World& world, double dt)
{
    StepReport report;
    report.dt = dt;
    GapScratch& scratch = *gaps_;
    aimKeyedBodies(world, dt);
    solveGaps(world, dt, SolvedIslands(), report);
    for (int looks = 0;;) {
        const bool someoneWoke = wakeStruck(world, dt, scratch);
        if (!someoneWoke && !lookFartherWhereUnseen(world, dt, scratch)) break;
        looks += !someoneWoke;
        if (looks > kMostLooks) {
            ++report.loopsAtTheirCap;
            break;
        }
        solveGaps(world, dt, SolvedIslands(scratch), report);
    }
    {
        const PhaseTimer timer(report.seconds, Phase::contact);
        report.contactImpulses = countImpulses(scratch);
        letRidersGo(world, dt, scratch);
    }
    for (const GapImpact& impact : scratch.impacts)
        countImpulse(report.collisionImpulses, impact.kind);
    if (observer_) observer_->stepDone(seeGaps(world, scratch, dt));
    {
        const PhaseTimer timer(report.seconds, Phase::position);
        writeVelocities(world, dt, scratch);
        moveBodies(world, settings_, dt, scratch);
        wakeUnbalanced(world, scratch.forces);
    }
    findNonFinite(world, Phase::position, report);
    report.deepestBeforePushOut = findWorstGap(world, scratch).depth;
    if (report.nonFinite.empty() && settings_.pushOut) {
        const PhaseTimer timer(report.seconds, Phase::pushOut);
        const double before = potentialEnergy(world, settings_.gravity);
        const PushOutTally tally = separateGaps(world, settings_, scratch);
        report.pushes = tally.pushes;
        report.pushesCut = tally.cut;
        report.pushOutWork = potentialEnergy(world, settings_.gravity) - before;
        if (tally.pushes > 0) findNonFinite(world, Phase::pushOut, report);
    }
    describeOverlap(findWorstGap(world, scratch), report);
    describeGaps(scratch, report);
    ++world.clock.subStep;
    return report;
}

/// Between any two steps, but for contacts that the next one would take along.
bool Stepper::mayStopAt(const Clock& clock) const
{
    return settings_.method == Method::paper || isSoughtAnewAt(clock);
}

FrameReport Stepper::advanceFrame(World& world, double frameDuration,
                                  const std::function<bool()>& stopRequested,
                                  const std::function<void(const World&, double)>& afterStep)
{
    FrameReport frame;
    world.frameDuration = frameDuration;
    while (true) {
        world.assignKinds();
        const double remaining = frameDuration - world.clock.frameTimeDone;
        StepLength length;
        PhaseSeconds limitSeconds{};
        {
            const PhaseTimer timer(limitSeconds, Phase::stepLimit);
            if (settings_.method == Method::scree) {
                findForces(world, settings_, remaining, scratch_->forces);
                // Before pairs are looked for, of which only those with somebody awake are found.
                if (world.clock.subStep == 0) wakeByForces(world, scratch_->forces);
                findCandidates(world, scratch_->forces, remaining, scratch_->candidates);
            } else {
                findPairs(world, settings_, remaining, *scratch_);
            }
            length = chooseStep(world, settings_, frameDuration, remaining, *scratch_);
        }
        StepReport report = settings_.method == Method::scree ? stepGaps(world, length.dt)
                                                              : stepFoundPairs(world, length.dt);
        report.limitedBy = length.limitedBy;
        report.seconds[static_cast<int>(Phase::stepLimit)] +=
            limitSeconds[static_cast<int>(Phase::stepLimit)];
        if (frame.steps == 0 || length.dt < frame.shortestStep) frame.fastestBody = length.body;
        frame.substepCapReached = frame.substepCapReached || length.capReached;
        addStep(report, frame);
        world.clock.frameTimeDone += length.dt;
        if (!report.nonFinite.empty()) break;
        const bool isLast = length.dt == remaining;
        if (afterStep) afterStep(world, isLast ? frameDuration : world.clock.frameTimeDone);
        if (isLast) {
            if (settings_.method == Method::scree && settings_.sleep)
                fallAsleep(world, settings_, *gaps_);
            world.clock = {world.clock.frame + 1, 0, 0.0};
            frame.births = giveBirths(world);
            break;
        }
        if (stopRequested && mayStopAt(world.clock) && stopRequested()) {
            frame.finished = false;
            break;
        }
    }
    describeState(world, settings_.gravity, frame);
    return frame;
}

}  // namespace scree
