// What is pressed between bodies that nothing can stop: a keyed plate and the floor, two keyed
// walls. There are no velocities that all of its contacts allow.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Whether an island, as its sweeps have left it, carries far more than it would take to bring all
/// of it to the speed of the keyed bodies it touches, or of those it does not move, and still
/// closes. `dt` [s].
bool isPressed(double dt, const GapScratch& scratch, const GapIsland& island);

/// Solves such an island anew, from how its bodies moved before, with contacts that yield the more
/// they carry: how far each is run into is shared out among them, and impulses have an end.
void solvePressed(double dt, const GapIsland& island, GapScratch& scratch);

}  // namespace scree
