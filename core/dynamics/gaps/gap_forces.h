// Phase 3 of method `scree`: what pulls at the bodies throughout the step, and what the rows have
// to close by its end.  [GBF03 “Time Integration”], [A28, A44; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Sets the targets of the rows of a block from their gaps and what impacts have shifted, and adds
/// the forces to its bodies.
void addForcesToGaps(double dt, const GapBlock& block, GapScratch& scratch);

/// The forces of all that is in no block, nor kept.
void addForcesToOthers(double dt, GapScratch& scratch);

}  // namespace scree
