// One time step and one frame: the table of contents of this folder.
#pragma once

#include <functional>
#include <memory>

#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

struct ContactGraph;
struct GapBlock;
struct StepScratch;
struct GapScratch;
class SolvedIslands;

/// Serves one world: what it remembers of pairs from step to step is found again by their bodies.
class Stepper {
public:
    explicit Stepper(const StepSettings& settings);
    ~Stepper();

    /// Advances the world by one time step of dt seconds. Of the clock only the sub-step moves on:
    /// scripts are followed by advanceFrame alone.  [GBF03 “Time Integration”], [A17]
    StepReport step(World& world, double dt);

    /// Advances the world to the end of the frame that its clock stands in, in as many steps as the
    /// limiter asks for [A16], and moves the clock on. `stopRequested` is asked between steps, by
    /// method `scree` after every fourth; when it answers true the world stays between two
    /// sub-steps and a later call goes on from there to the same bits.
    /// `afterStep` is called after every step with the world and the time reached since the frame
    /// began [s]; it may look, for poses between frames, but change nothing.
    FrameReport advanceFrame(World& world, double frameDuration,
                             const std::function<bool()>& stopRequested = {},
                             const std::function<void(const World&, double)>& afterStep = {});

    /// From now on shows every step to `observer`, which must outlive the stepper; null: to nobody.
    void observe(StepObserver* observer) { observer_ = observer; }

private:
    /// The step proper, with the pairs that may meet already in scratch.
    StepReport stepFoundPairs(World& world, double dt);
    void separateFoundPairs(World& world, const ContactGraph& graph, StepReport& report);
    StepReport stepGaps(World& world, double dt);
    bool mayStopAt(const Clock& clock) const;
    PhaseSeconds solveBlock(const World& world, double dt, GapBlock& block);
    void solveGaps(World& world, double dt, const SolvedIslands& solved, StepReport& report);

    StepSettings settings_;
    StepObserver* observer_ = nullptr;
    std::unique_ptr<StepScratch> scratch_;
    std::unique_ptr<GapScratch> gaps_;
};

}  // namespace scree
