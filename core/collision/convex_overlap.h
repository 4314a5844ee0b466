// How deep two convex bodies are in each other, and the shortest way out, by the theorem of the
// separating axis: the axes are the normals of their faces and those across two edges that make a
// face of their Minkowski difference.
//
// Of shallow overlap corners and edges tell. Shards under a roller were pressed a quarter of their
// size into each other, and then none of their features told more than a hundredth of it: they
// stayed there.
#pragma once

#include <optional>

#include "core/collision/relative_pair.h"

namespace scree {

/// The shortest way out of each other, as a contact; nothing unless both are convex
/// (ContactFeatures::isConvex) and overlap.
std::optional<FeatureContact> overlapOfConvex(const RelativePair& pair);

}  // namespace scree
