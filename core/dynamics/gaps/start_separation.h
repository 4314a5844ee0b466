// Pushing apart what overlaps before the first step.
#pragma once

#include <cstddef>
#include <functional>

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// Is told before each round how many pairs still overlap; what it throws ends the search, and
/// leaves bodies where they are by then.
using SeparationProgress = std::function<void(std::size_t pairsLeft)>;

/// Pushes bodies apart, without giving them velocity, until nothing overlaps by more than half of
/// `leastRatio` or through a wall; false when that does not come about. Bodies that overlap nothing
/// stay where they are.
bool separateAtStart(World& world, const StepSettings& settings, double leastRatio,
                     const SeparationProgress& tell = {});

}  // namespace scree
