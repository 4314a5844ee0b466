// One step of method `scree`, and what goes with it around a frame: the table of contents of this
// folder.  [algorithm 14]
#pragma once

#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/candidates.h"
#include "core/dynamics/gaps/gap_scratch.h"
#include "core/dynamics/settings.h"
#include "core/dynamics/step_limit.h"
#include "core/scene/world.h"

namespace scree {

class SolvedIslands;

/// Serves one world, as Stepper does.
class GapStepper {
public:
    explicit GapStepper(const StepSettings& settings);

    /// How long the next step shall be, when `remaining` seconds of the frame are left. At the
    /// beginning of a frame it wakes sleepers on whom forces have changed.
    StepLength chooseLength(World& world, double frameDuration, double remaining);

    /// Advances the world by one step of dt seconds and shows it to `observer`, if there is one.
    StepReport step(World& world, double dt, StepObserver* observer);

    /// Between any two steps, but for contacts that the next one would take along.
    bool mayStopAt(const Clock& clock) const;

    /// After the last step of a frame: who lies still falls asleep.
    void endFrame(World& world);

private:
    PhaseSeconds solveBlock(const World& world, double dt, GapBlock& block);
    bool solveGaps(World& world, double dt, const SolvedIslands& solved, StepReport& report);

    StepSettings settings_;
    std::vector<AppliedForce> forces_;  // per body, over the rest of the frame
    Candidates candidates_;             // for that time
    GapScratch scratch_;
};

}  // namespace scree
