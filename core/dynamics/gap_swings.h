// What swings on what it hangs from: within a step it leaves the straight way on which its velocity
// takes it.  [algorithm 14.1]
#pragma once

#include "core/dynamics/gap_scratch.h"

namespace scree {

/// Sets the targets of rows that hold what swings to where their places will be, going round, by
/// the end of the step. They must be those of straight ways.
void holdSwings(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                GapScratch& scratch);

}  // namespace scree
