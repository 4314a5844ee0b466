// The end of a step of method `scree`: velocities go back into the world, and everything is moved.
// [GBF03 “Time Integration”], [A17–A19; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Velocities and angular momenta of the world from the solved rows; remembers the impulses.
void writeVelocities(World& world, double dt, GapScratch& scratch);

/// Moves every body with its new velocity and its shift; where all contacts last, with the mean of
/// the velocities before and after the step.
void moveBodies(World& world, const StepSettings& settings, double dt, GapScratch& scratch);

}  // namespace scree
