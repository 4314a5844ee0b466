// What is about to be hit, looked at where it will be then.
//
// A row knows its gap along the normal that it has when the step begins. What goes by may close
// that gap and never touch: an edge of a cube flies a hand above that of a table, and the row
// between the two, almost level while they are far, foresees a head-on blow. So does a corner that
// slides over the seam between two flush blocks, for which the wall of the second is ahead. Before
// anything is answered, bodies that are about to hit each other are looked at where they would be
// a little later, on their ways as they are: what hits has gone in by then.
//
// What hits, hits along the normal of that moment. A billiard ball that goes half its size in a
// step met another one along the line between them as the step began, up to 13 degrees off.
#pragma once

#include <vector>

#include "core/dynamics/gap_held.h"
#include "core/dynamics/gap_scratch.h"

namespace scree {

/// Widens the gaps of those rows of a block that their bodies would only pass, as far as these go
/// within the step, held up as `held` says; and takes those between round surfaces from the moment
/// of their blow. Before impacts. [A28]
void foreseeBlows(const World& world, double dt, const std::vector<Held>& held,
                  const GapBlock& block, GapScratch& scratch);

}  // namespace scree
