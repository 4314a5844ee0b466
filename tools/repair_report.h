// What was done to the meshes of a shot before they became bodies.
#pragma once

#include <string>
#include <vector>

#include "core/scene/world.h"

namespace scree {

/// How far what collides is from what is drawn, and where in the asset's frame [m].
std::string describe(const MeshDeviation& drawnToColliding);

/// One sentence for each shape whose mesh was repaired, or is not the one that collides.
std::vector<std::string> repairsOf(const World& world);

}  // namespace scree
