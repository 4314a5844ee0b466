// What one visit does to a row: the impulse that keeps its gap from closing past zero, its
// friction, and its resistance to rolling and spinning. The plain readable twin of the lanes
// (gap_lanes.h). [GBF03 “Contact”], [A43, A49; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_rows.h"

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

}  // namespace scree
