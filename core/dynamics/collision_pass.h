// Phase 1: collisions at predicted positions change velocities that have not felt gravity yet.
// [GBF03 “Collisions”], [A22–A24, A26]
#pragma once

#include "core/dynamics/pair_visits.h"

namespace scree {

/// Applies collision impulses to world.motion and records in scratch.pairs which pairs have
/// interfered at all (isTouched).
PassTally resolveCollisions(World& world, const StepSettings& settings, double dt,
                            StepScratch& scratch);

}  // namespace scree
