// What is about to be hit, looked at where it will be then.
//
// A row knows its gap along the normal that it has when the step begins. What goes by may close
// that gap and never touch: an edge of a cube flies a hand above that of a table, and the row
// between the two, almost level while they are far, foresees a head-on blow. So does a corner that
// slides over the seam between two flush blocks, for which the wall of the second is ahead. Before
// anything is answered, bodies that are about to hit each other are looked at where they would be
// a little later, on their ways as they are: what hits has gone in by then.
//
// What hits, hits along the normal of that moment, at the places of that moment, and finds a body
// that has turned until then. A billiard ball that goes half its size in a step met another one
// along the line between them as the step began, up to 13 degrees off; a rod that landed on a
// corner as it turned, at 3 m/s, left up to 0.2 m/s off.
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_held.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Widens the gaps of those rows of a block that their bodies would only pass, as far as these go
/// within the step, held up as `held` says; takes from the moment of their blow those whose place
/// or normal is another then, and the spin and the inertia of what flies freely. Before impacts.
/// [A28]
void foreseeBlows(const World& world, const StepSettings& settings, double dt,
                  const std::vector<Held>& held, const GapBlock& block, GapScratch& scratch);

/// Once blows are done all rows of a pair have arms to one place again. What carries for the whole
/// step knows no moment of it; and GapLanes has one way between the centres for all rows of a pair:
/// a chip under eight thousand times its weight, one of whose corners was about to be hit, was told
/// of one spin and given another that differed by 330 rad/s.
void forgetMomentsOfBlows(const World& world, const GapBlock& block, GapScratch& scratch);

}  // namespace scree
