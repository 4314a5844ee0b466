// What a step of method `scree` may close: the gaps around every body as far as it may come, and a
// second look where a blow has sent it farther.  [A14; algorithm 14.1]
//
// A body at rest beside others has no reason to look far. Struck within the step by something fast
// it once ran 46 mm into a neighbour, in one of sixteen runs of a hundred rings.
#pragma once

#include "core/dynamics/gap_rows.h"

namespace scree {

/// Finds all contacts that may close within dt. Wakes what they are about to disturb.
void findGaps(World& world, const StepSettings& settings, double dt, GapScratch& scratch);

/// Whether the step, as solved, takes a body visibly into something that lay farther away than
/// anything it could have reached before it was struck. If so the next findGaps looks farther: the
/// step has to be solved again.
bool meetsUnseen(const World& world, double dt, GapScratch& scratch);

}  // namespace scree
