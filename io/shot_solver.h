// [solver] and [start]: how hard each phase works, and what happens before the first frame.
#pragma once

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// Fills shot.settings and the limits of overlap from a checked [solver] table. True when it asks
/// for the paper without its repairs.
bool readSolver(const ShotNode& table, Shot& shot, ProblemList& problems);

/// Fills shot.startOverlap from a checked [start] table.
void readStart(const ShotNode& table, Shot& shot);

}  // namespace scree
