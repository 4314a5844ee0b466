// Phases 3 and 4 of method `scree`: the impulses that keep every gap from closing past zero, with
// friction; and shock propagation where they are not enough.
// [GBF03 “Contact”, “Shock Propagation”], [A39–A48; algorithm 14.1]
#pragma once

#include "core/dynamics/gap_scratch.h"

namespace scree {

/// One visit. Answers how much it changed the velocity there [m/s].
double visitRow(GapRow& row, GapBody& a, GapBody& b);

/// The same of a row whose surfaces move with u, along normal, tangent and second tangent: changes
/// the impulse alone. Of a row that does not resist spin, or not here.
double visitRow(GapRow& row, const Vec3& u);

/// How much of the way that its impulses went in the last sweep an island goes again, by the
/// energies of what that sweep and the one before changed. Above 1: none, the active set has
/// changed.
///
/// A body wedged between places that contradict each other by a hair gets the same impulses sweep
/// after sweep until friction gives way. There rounding decided whether to begin anew, and one in
/// thirty islands of a hundred rings came to no end in 400 sweeps, half of all that were made. What
/// grows by less than a hundredth goes on: one in eighty, and a third fewer visits.
inline double shareOfLastWay(double energy, double energyBefore)
{
    constexpr double kSteady = 0.01;
    const double share = energyBefore > 0.0 ? energy / energyBefore : 0.0;
    return share > 1.0 && share <= 1.0 + kSteady ? 1.0 : share;
}

/// Too many rows for more sweeps than the settings say.
bool isHeap(const StepSettings& settings, const GapIsland& island);

/// Sets the targets of the rows of a block from their gaps and what impacts have shifted, and adds
/// the forces to its bodies.
void addForcesToGaps(double dt, const GapBlock& block, GapScratch& scratch);

/// The forces of all that is in no block, nor kept.
void addForcesToOthers(double dt, GapScratch& scratch);

/// Sweeps over the rows of every island of a block until velocities stay as they are, or its sweeps
/// are used up. Begins with the impulses that rows remember, or, on an island that remembers
/// nothing, with the weights of the levels.
void resolveGaps(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                 GapScratch& scratch);

/// Counts the impulses of all rows, and those of each pair.
ImpulseCounts countImpulses(GapScratch& scratch);

}  // namespace scree
