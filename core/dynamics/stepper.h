// One time step and one frame: the table of contents of this folder. Method `scree` has its own
// step, in gaps/gap_step.h.
#pragma once

#include <functional>
#include <memory>

#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

struct ContactGraph;
struct StepLength;
struct StepScratch;
class GapStepper;

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
    StepLength chooseLength(World& world, double frameDuration, double remaining);
    StepReport takeStep(World& world, double dt);
    StepReport stepFoundPairs(World& world, double dt);
    void separateFoundPairs(World& world, const ContactGraph& graph, StepReport& report);

    StepSettings settings_;
    StepObserver* observer_ = nullptr;
    std::unique_ptr<StepScratch> scratch_;  // of method `paper`
    std::unique_ptr<GapStepper> gaps_;      // method `scree`; null: method `paper` is asked for
};

}  // namespace scree
