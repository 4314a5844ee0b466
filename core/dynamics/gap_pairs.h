// The pairs of a step that have contacts: which belong together, and in which order they are
// visited.
#pragma once

#include <vector>

#include "core/dynamics/gap_rows.h"

namespace scree {

/// Collects the pairs for which contacts have been found, bottom to top and by islands, cut for two
/// threads where they are large. Of their rows it says how many there are, not yet where.
void layPairs(const World& world, const StepSettings& settings, GapScratch& scratch);

/// Those of the pairs together that share movable bodies, directly or through others; pairs without
/// any are left out. In the order of the first of each.
std::vector<std::vector<std::size_t>> pairsByBodies(const GapScratch& scratch,
                                                    const std::vector<std::size_t>& pairs);

/// The pairs by their parts, in their order.
PairParts partsOf(const GapScratch& scratch, const std::vector<std::size_t>& pairs);

}  // namespace scree
