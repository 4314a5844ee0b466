// Overlaps before the first frame: what the shot wants done about them, done and told.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/start_overlap.h"
#include "io/shot.h"
#include "tools/console.h"

namespace scree {

/// "cup and saucer: 3.1 mm, 4.2 % of the smaller one"; where one of them has keys, its name too.
std::string describe(const StartOverlap& overlap, const World& world);

/// The first few, a line each, and in one more how many there are besides. The worst come first.
std::vector<std::string> describeWorst(const std::vector<StartOverlap>& overlaps,
                                       const World& world);

/// Applies shot.startOverlap to the world at time zero. Throws Error{badInput} that names the pairs
/// when they are an error or will not come apart.
void applyStartRule(const Shot& shot, World& world, Console& console);

/// Says what applyStartRule will do about those overlaps, without doing it; false when it will
/// refuse the shot.
bool foretellStartRule(const Shot& shot, const World& world,
                       const std::vector<StartOverlap>& overlaps, Console& console);

}  // namespace scree
