// What swings on what it hangs from, and what rides on something that turns: within a step both
// leave the straight way on which their velocities take them.  [algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Lets the rows of all that is no heap know where their places will be, going round: by their
/// targets, which must be those of straight ways, and by GapRow::turning.
void holdSwings(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                GapScratch& scratch);

}  // namespace scree
