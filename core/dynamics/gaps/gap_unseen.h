// Whether a blow sends a body where nobody has looked: then the step is solved again.  [algorithm
// 14.1]
//
// A body at rest beside others has no reason to look far. Struck within the step by something fast
// it once ran 46 mm into a neighbour, in one of sixteen runs of a hundred rings. And of two that
// fall side by side one may be stopped, and the other run into it. Two that would pass each other
// are let pass (gap_foresight.h), and a blow of a third may divert one of them into the other: of
// marbles that bounce down stairs some overlapped by a fiftieth of their size.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Whether the step, as solved, takes a body visibly into something that lay farther away than
/// findGaps has looked for, or that it was let pass. If so the next findGapsAgain looks farther,
/// and the next foreseeBlows lets none of these pass.
bool lookFartherWhereUnseen(const World& world, double dt, GapScratch& scratch);

}  // namespace scree
