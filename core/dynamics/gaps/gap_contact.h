// Phase 4 of method `scree`: the impulses that keep every gap from closing past zero, with
// friction, by sweeps over the rows.  [GBF03 “Contact”], [A39–A46; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Too many rows to be solved to the end.
bool isHeap(const GapIsland& island);

/// What rounding leaves of the speeds at which the gaps of an island close in a step [m/s]: the
/// only limit where nothing pulls. 216 cubes that touched in a lattice took all the sweeps there
/// are.
double roundingOfSpeeds(const World& world, const GapIsland& island, double dt);

/// Sweeps over the rows of every island of a block until velocities stay as they are, or its sweeps
/// are used up. Begins with the impulses that rows remember, or, on an island that remembers
/// nothing, with the weights of the levels.
void resolveGaps(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                 GapScratch& scratch);

/// Counts the impulses of all rows, and those of each pair.
ImpulseCounts countImpulses(GapScratch& scratch);

}  // namespace scree
