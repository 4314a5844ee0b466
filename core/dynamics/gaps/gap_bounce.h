// Phase 1 of method `scree`: impacts, at the moment within the step at which the surfaces meet.
// [GBF03 “Collisions”], [A22–A26; algorithm 14.1]
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_held.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Gives every impact that the step brings to a block its impulse. Velocities are those before
/// gravity, and stay so. Bodies get shifts that let them move with the old velocity up to the
/// impact. `held`: as heldAsBefore tells.
void resolveImpacts(const StepSettings& settings, double dt, const std::vector<Held>& held,
                    GapBlock& block, GapScratch& scratch);

}  // namespace scree
