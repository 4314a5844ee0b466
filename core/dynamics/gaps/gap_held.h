// What carried the bodies of method `scree` in the last step, and will again if nothing happens.
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Per place of a body in the block, if all that carried it in the last step does so again: rows
/// begin with the impulses that are remembered. Fills block.held.
const std::vector<Held>& heldAsBefore(double dt, GapBlock& block, const GapScratch& scratch);

}  // namespace scree
