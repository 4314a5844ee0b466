// What a step of method `scree` tells of itself, and what an observer is shown of it, gathered from
// what its passes leave behind. Nothing here moves a body.  [A58, A59]
#pragma once

#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Pairs, contacts and levels.
void describeGaps(const GapScratch& scratch, StepReport& report);

/// Before bodies have moved: rows measure their points from where these are.
StepSeen seeGaps(const World& world, const GapScratch& scratch, double dt);

}  // namespace scree
