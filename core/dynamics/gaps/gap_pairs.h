// The pairs of a step that have contacts: which belong together, and in which order they are
// visited.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Pairs of one half of the bodies, of the other, and those that join the halves. Two threads may
/// work on the halves at once, and one on the rest before or after them.
using PairParts = std::array<std::span<const std::size_t>, 3>;

/// Below this many rows a cut costs more than a second thread gains.
inline constexpr std::size_t kRowsWorthACut = 1000;

/// Collects the pairs for which contacts have been found, by islands. Of their rows it says how
/// many there are, not yet where.
void layPairs(const World& world, GapScratch& scratch);

/// Orders the pairs of all islands that are not kept bottom to top, and cuts these for two threads
/// where they are large.
void orderPairs(const World& world, GapScratch& scratch);

/// Groups those of the pairs together that share movable bodies, directly or through others; pairs
/// without any are left out. In the order of the first of each.
void groupByBodies(const GapScratch& scratch, std::span<const std::size_t> pairs, Groups& together);

/// The pairs of an island by their parts, in their order: in `room` where it is cut, and otherwise
/// all in the first, where they are.
PairParts partsOf(const GapScratch& scratch, const GapIsland& island,
                  std::vector<std::size_t>& room);

}  // namespace scree
