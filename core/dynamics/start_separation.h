// Pushing apart what overlaps before the first step.
#pragma once

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// Pushes bodies apart, without giving them velocity, until nothing overlaps by more than half of
/// `leastRatio` or through a wall; false when that does not come about. Bodies that overlap nothing
/// stay where they are.
bool separateAtStart(World& world, const StepSettings& settings, double leastRatio);

}  // namespace scree
