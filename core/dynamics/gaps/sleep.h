// Sleep by result: bodies that the full step leaves where they are need not be stepped.
// [algorithm 14]
//
// A body falls asleep when for the time it takes to fall over it has stayed in one place
// (stillness.h), the forces of its contacts balance what pulls it (contact_load.h), and nothing
// that is awake holds it up: a ring that rocks on top of a heap keeps nobody awake but itself
// (calming.h). Who sleeps has exactly no motion, costs nothing but its box, and is a fixed body to
// all others, until something wakes it (waking.h).
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Before the first frame: puts dynamic bodies to sleep where they stand, held up or not, until
/// something comes closer or a force on them changes. Those of them that touch wake together.
void sleepFromTheStart(World& world, const StepSettings& settings,
                       const std::vector<BodyId>& bodies);

/// At the end of a frame: notes who has moved, and puts to sleep what lies still. `scratch` holds
/// the rows of the last step.
void fallAsleep(World& world, const StepSettings& settings, const GapScratch& scratch);

}  // namespace scree
