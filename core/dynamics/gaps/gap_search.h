// What a step of method `scree` may close: the gaps around every body as far as it may come.  [A14;
// algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Finds all contacts that may close within dt. Wakes what they are about to disturb.
void findGaps(World& world, const StepSettings& settings, double dt, GapScratch& scratch);

/// The same for another attempt at the step: of bodies that have woken, and of those that
/// scratch.gain and scratch.looksFar tell to look farther.
void findGapsAgain(World& world, double dt, GapScratch& scratch);

/// Whether two bodies may collide, and one of them moves or can be moved.
bool isMovedPair(const World& world, const GapScratch& scratch, BodyPair pair);

}  // namespace scree
