// Who sleeps (sleep.h) wakes when what awake neighbours press on it with no longer balances. A blow
// cannot wait for that: the step is solved again with those awake that it would have moved.
// [algorithm 14]
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Before the first step of a frame, whose length depends on who is awake: wakes those on whom
/// `forces`, of the whole frame, are no longer as they were when they fell asleep, and those that a
/// script has taken over, and those that have lain for long under what does not quite balance.
void wakeByForces(World& world, const std::vector<AppliedForce>& forces);

/// Wakes sleepers that a keyed body is about to touch or moves away from, or one that they do not
/// move, and what hangs in the air asleep and anything is about to touch. True when any woke: their
/// own contacts must be found then.
bool wakeByTouch(World& world, double dt, const GapScratch& scratch);

/// When a step has been solved, before anything moves: wakes sleepers that were struck, and those
/// around them. True when any woke: the step must be solved again.
bool wakeStruck(World& world, double dt, const GapScratch& scratch);

/// After a step: wakes sleepers on which the forces of their contacts no longer balance.
void wakeUnbalanced(World& world, const std::vector<AppliedForce>& forces);

}  // namespace scree
