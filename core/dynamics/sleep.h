// Sleep by result: bodies that the full step leaves where they are need not be stepped.
// [algorithm 14]
//
// Nor need what rocks in its place for long be let rock for good: it loses its motion by and by.
//
// No velocity decides. A set of touching bodies falls asleep when over kStillFrames frames every
// one of them has stayed within kStill of its size of one place; it then has exactly no motion, and
// costs nothing but its box. It wakes as a whole when something comes closer than its gaps allow,
// when one of its forces changes, or when what it rests on is moved.
#pragma once

#include <vector>

#include "core/dynamics/gap_rows.h"

namespace scree {

/// Before the first frame: puts dynamic bodies to sleep where they stand, held up or not, until
/// something comes closer or a force on them changes. Those of them that touch wake together.
void sleepFromTheStart(World& world, const StepSettings& settings,
                       const std::vector<BodyId>& bodies);

/// At the end of a frame: notes who has moved, calms what rocks in its place, and puts to sleep
/// what has not moved at all. `scratch` holds the rows of the last step.
void fallAsleep(World& world, GapScratch& scratch);

/// Before a step: wakes what forces no longer leave alone.
void wakeByForces(World& world, const std::vector<AppliedForce>& forces);

/// Wakes sleeping bodies that an awake or keyed one is about to touch, with all that lies with
/// them. True when any woke: their own contacts must be found then.
bool wakeByTouch(World& world, double dt, const GapScratch& scratch);

}  // namespace scree
