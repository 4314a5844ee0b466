// A step of method `scree`, the same pipeline as the paper's on contacts that are known before they
// touch: a step is laid out and solved, in the scratch alone, until nobody is woken by it nor runs
// into what was not looked at; then everything moves at once.
#include "core/dynamics/gaps/gap_step.h"

#include <algorithm>
#include <vector>

#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/gaps/calming.h"
#include "core/dynamics/gaps/gap_blocks.h"
#include "core/dynamics/gaps/gap_bounce.h"
#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/gaps/gap_forces.h"
#include "core/dynamics/gaps/gap_foresight.h"
#include "core/dynamics/gaps/gap_grip.h"
#include "core/dynamics/gaps/gap_kept.h"
#include "core/dynamics/gaps/gap_laden.h"
#include "core/dynamics/gaps/gap_lag.h"
#include "core/dynamics/gaps/gap_layout.h"
#include "core/dynamics/gaps/gap_lead.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_motion.h"
#include "core/dynamics/gaps/gap_overrun.h"
#include "core/dynamics/gaps/gap_push_out.h"
#include "core/dynamics/gaps/gap_report.h"
#include "core/dynamics/gaps/gap_riders.h"
#include "core/dynamics/gaps/gap_shock.h"
#include "core/dynamics/gaps/gap_swings.h"
#include "core/dynamics/gaps/gap_unseen.h"
#include "core/dynamics/gaps/sleep.h"
#include "core/dynamics/gaps/waking.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/step_figures.h"

namespace scree {
namespace {

/// How often a step is solved again because something was struck so that it ran into what nobody
/// had looked at.
constexpr int kMostLooks = 64;

}  // namespace

GapStepper::GapStepper(const StepSettings& settings) : settings_(settings) {}

StepLength GapStepper::chooseLength(World& world, double frameDuration, double remaining)
{
    findForces(world, settings_, remaining, forces_);
    // Before pairs are looked for, of which only those with somebody awake are found.
    if (world.clock.subStep == 0) wakeByForces(world, forces_);
    findCandidates(world, forces_, remaining, candidates_);
    return chooseStep(world, settings_, frameDuration, remaining, {candidates_.pairs, forces_});
}

/// New velocities for the bodies of a block, in the scratch alone. Answers the time each phase took
/// [s].
PhaseSeconds GapStepper::solveBlock(const World& world, double dt, GapBlock& block)
{
    GapScratch& scratch = scratch_;
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
        holdSwings(world, dt, leads, block, scratch);
    }
    LadenBodies laden(dt, block, scratch);
    {
        const PhaseTimer timer(seconds, Phase::contact);
        resolveGaps(world, settings_, dt, block, scratch);
    }
    if (settings_.shockPropagation) {
        const PhaseTimer timer(seconds, Phase::shock);
        propagateShockUp(world, dt, block, scratch);
    }
    laden.release();
    takeBack(leads, scratch);
    return seconds;
}

/// New velocities, in the scratch alone: the world is as it was. `solved`: by an earlier attempt.
/// Answers whether blows went on for as long as they may.
bool GapStepper::solveGaps(World& world, double dt, const SolvedIslands& solved, StepReport& report)
{
    GapScratch& scratch = scratch_;
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
    return std::ranges::any_of(scratch.blocks, &GapBlock::isAtItsCap);
}

StepReport GapStepper::step(World& world, double dt, StepObserver* observer)
{
    StepReport report;
    report.dt = dt;
    GapScratch& scratch = scratch_;
    aimKeyedBodies(world, dt);
    bool isAtItsCap = solveGaps(world, dt, SolvedIslands(), report);
    for (int looks = 0;;) {
        const bool someoneWoke = wakeStruck(world, dt, scratch);
        if (!someoneWoke && !lookFartherWhereUnseen(world, dt, scratch)) break;
        looks += !someoneWoke;
        if (looks > kMostLooks) {
            isAtItsCap = true;
            break;
        }
        isAtItsCap |= solveGaps(world, dt, SolvedIslands(scratch), report);
    }
    report.loopsAtTheirCap = isAtItsCap;
    {
        const PhaseTimer timer(report.seconds, Phase::contact);
        report.contactImpulses = countImpulses(scratch);
        letRidersGo(world, dt, scratch);
    }
    for (const GapImpact& impact : scratch.impacts)
        countImpulse(report.collisionImpulses, impact.kind);
    if (observer) observer->stepDone(seeGaps(world, scratch, dt));
    {
        const PhaseTimer timer(report.seconds, Phase::position);
        writeVelocities(world, dt, scratch);
        moveBodies(world, settings_, dt, scratch);
        wakeUnbalanced(world, scratch.forces);
        if (settings_.sleep) calmWhatRocks(world, dt, scratch);
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

bool GapStepper::mayStopAt(const Clock& clock) const
{
    return isSoughtAnewAt(clock);
}

void GapStepper::endFrame(World& world)
{
    if (settings_.sleep) fallAsleep(world, settings_, scratch_);
}

}  // namespace scree
