// Before the first frame: what the shot wants done about overlaps, done and told.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/start_check.h"
#include "core/dynamics/start_overlap.h"
#include "io/shot.h"
#include "tools/console.h"

namespace scree {

/// "cup and saucer: 3.1 mm, 4.2 % of the smaller one".
std::string describe(const StartOverlap& overlap, const World& world);

/// How far what collides is from what is drawn, and where in the asset's frame [m].
std::string describe(const MeshDeviation& drawnToColliding);

/// Applies shot.startOverlap to the world at time zero. Throws Error{badInput} that names the pairs
/// when they are an error or will not come apart.
void applyStartRule(const Shot& shot, World& world, Console& console);

/// Says what applyStartRule will do about those overlaps, without doing it; false when it will
/// refuse the shot.
bool foretellStartRule(const Shot& shot, const World& world,
                       const std::vector<StartOverlap>& overlaps, Console& console);

/// What will not do as it is: bodies that nothing holds, speeds beyond the cap, and what the shot's
/// files held that is lost. One sentence each.
std::vector<std::string> warningsBeforeStart(const Shot& shot, const World& world);

/// One sentence for each shape whose mesh was repaired, or is not the one that collides.
std::vector<std::string> repairsOf(const World& world);

}  // namespace scree
