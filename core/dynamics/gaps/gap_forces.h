// Phase 3 of method `scree`: what pulls at the bodies throughout the step, and what the rows have
// to close by its end.  [GBF03 “Time Integration”], [A28, A44; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Sets the targets of the rows of a block from their gaps and what impacts have shifted, and adds
/// the forces to its bodies.
void addForcesToGaps(double dt, const GapBlock& block, GapScratch& scratch);

/// The strongest pull at a body of an island: beside what it does in a step all else is little or
/// much. Of most it is gravity [m/s²].
double strongestPull(const GapScratch& scratch, const GapIsland& island);

/// The mean of what pulls at the bodies of an island [m/s²].
Vec3 meanPull(const GapScratch& scratch, const GapIsland& island);

/// The forces of all that is in no block, nor kept.
void addForcesToOthers(double dt, GapScratch& scratch);

}  // namespace scree
