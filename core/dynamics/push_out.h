// Optional last phase: first-order separation of what still overlaps. Changes positions and
// orientations only.  [GBF03 “Shock Propagation”, last paragraph], [A52]
#pragma once

#include "core/dynamics/contact_graph.h"
#include "core/dynamics/push_limits.h"
#include "core/dynamics/scratch.h"

namespace scree {

/// Pushes apart level by level, a growing fraction of the depth at a time; finished levels stay
/// put.
PushOutTally separateOverlaps(World& world, const ContactGraph& graph, const StepSettings& settings,
                              StepScratch& scratch);

/// The worst interference below 0 of the touching pairs where the bodies are now.
WorstOverlap findWorstOverlap(const World& world, StepScratch& scratch);

}  // namespace scree
