// The last phase of method `scree`: what overlaps is drawn apart, in positions only.
// [GBF03 “Shock Propagation”, last paragraph], [A52; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"
#include "core/dynamics/push_limits.h"

namespace scree {

/// Draws overlaps apart: those that steps leave bit by bit, deeper ones at once. The shifts of the
/// bodies must be their displacements of this step. Where it draws deep ones apart, their pairs
/// have the depth that is left.
PushOutTally separateGaps(World& world, const StepSettings& settings, GapScratch& scratch);

/// The worst overlap of any pair as last seen: at the beginning of the step, or, where deep ones
/// were drawn apart, since.
WorstOverlap findWorstGap(const World& world, const GapScratch& scratch);

}  // namespace scree
