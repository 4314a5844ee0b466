// From bodies to blocks of rows that can be solved: what a step of method `scree`, or a push
// without one, begins with.
#pragma once

#include "core/dynamics/gaps/gap_kept.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Finds the gaps that may close within the step, wakes who is about to be touched, and lays out
/// pairs, islands and blocks. `solved`: by an earlier attempt at the step, whose islands are kept
/// where nothing has changed. Rows have room and are not built yet.
void layOutGaps(World& world, const StepSettings& settings, double dt, const SolvedIslands& solved,
                GapScratch& scratch);

}  // namespace scree
