// Sleep by result: bodies that the full step leaves where they are need not be stepped.
// [algorithm 14]
//
// Nor need what rocks in its place for long be let rock for good: it loses its motion by and by.
//
// A body falls asleep when for the time it takes to fall over it has stayed within kStill of its
// size of one place, the forces of its contacts balance what pulls it, and nothing that is awake
// holds it up: a ring that rocks on top of a heap keeps nobody awake but itself. Who sleeps has
// exactly no motion, costs nothing but its box, and is a fixed body to all others. It wakes when
// what awake neighbours press on it with no longer balances. A blow cannot wait for that: the step
// is solved again with those awake that it would have moved.
#pragma once

#include <vector>

#include "core/dynamics/gap_scratch.h"

namespace scree {

/// Before the first frame: puts dynamic bodies to sleep where they stand, held up or not, until
/// something comes closer or a force on them changes. Those of them that touch wake together.
void sleepFromTheStart(World& world, const StepSettings& settings,
                       const std::vector<BodyId>& bodies);

/// At the end of a frame: notes who has moved, calms what rocks in its place, and puts to sleep
/// what lies still. `scratch` holds the rows of the last step.
void fallAsleep(World& world, const GapScratch& scratch);

/// Before a step: wakes what forces no longer leave alone.
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
