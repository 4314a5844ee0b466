// The paper's step, phase by phase [GBF03 “Time Integration”], and the loop over a frame, which
// method `scree` shares.
#include "core/dynamics/stepper.h"

#include <algorithm>
#include <utility>

#include "core/base/random.h"
#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/births.h"
#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/gaps/gap_step.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/push_out.h"
#include "core/dynamics/scratch.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/step_limit.h"
#include "core/dynamics/step_view.h"

namespace scree {
namespace {

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
      gaps_(settings.method == Method::scree ? std::make_unique<GapStepper>(settings) : nullptr)
{
}

Stepper::~Stepper() = default;

StepReport Stepper::step(World& world, double dt)
{
    world.assignKinds();
    if (!gaps_) findPairs(world, settings_, dt, *scratch_);
    return takeStep(world, dt);
}

StepReport Stepper::takeStep(World& world, double dt)
{
    return gaps_ ? gaps_->step(world, dt, observer_) : stepFoundPairs(world, dt);
}

/// How long the next step shall be. Method `paper` keeps the pairs it is chosen by.
StepLength Stepper::chooseLength(World& world, double frameDuration, double remaining)
{
    if (gaps_) return gaps_->chooseLength(world, frameDuration, remaining);
    findPairs(world, settings_, remaining, *scratch_);
    return chooseStep(world, settings_, frameDuration, remaining,
                      {scratch_->candidates.pairs, scratch_->forces});
}

/// With the pairs that may meet already in the scratch.
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

FrameReport Stepper::advanceFrame(World& world, double frameDuration,
                                  const std::function<bool()>& stopRequested,
                                  const std::function<void(const World&, double)>& afterStep)
{
    FrameReport frame;
    world.frameDuration = frameDuration;
    while (true) {
        world.assignKinds();
        const double remaining = frameDuration - world.clock.frameTimeDone;
        const Stopwatch watch;
        const StepLength length = chooseLength(world, frameDuration, remaining);
        const double secondsToChoose = watch.seconds();
        StepReport report = takeStep(world, length.dt);
        report.limitedBy = length.limitedBy;
        report.seconds[static_cast<int>(Phase::stepLimit)] += secondsToChoose;
        if (frame.steps == 0 || length.dt < frame.shortestStep) frame.fastestBody = length.body;
        frame.substepCapReached = frame.substepCapReached || length.capReached;
        addStep(report, frame);
        world.clock.frameTimeDone += length.dt;
        if (!report.nonFinite.empty()) break;
        const bool isLast = length.dt == remaining;
        if (afterStep) afterStep(world, isLast ? frameDuration : world.clock.frameTimeDone);
        if (isLast) {
            if (gaps_) gaps_->endFrame(world);
            world.clock = {world.clock.frame + 1, 0, 0.0};
            frame.births = giveBirths(world);
            break;
        }
        const bool mayStop = !gaps_ || gaps_->mayStopAt(world.clock);
        if (stopRequested && mayStop && stopRequested()) {
            frame.finished = false;
            break;
        }
    }
    describeState(world, settings_.gravity, frame);
    return frame;
}

}  // namespace scree
