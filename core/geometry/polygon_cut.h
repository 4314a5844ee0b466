// Cuts polygons into triangles, by ears.
#pragma once

#include <vector>

#include "core/math/types.h"

namespace scree {

/// `corners` (3×#C) go around a polygon that need be neither convex nor quite flat. Answers #C − 2
/// triangles that fill it, as indices of corners, three each and turning as it does; the corners of
/// a convex one as a fan around the first. None of them is flat, though many corners may lie on a
/// line. Empty when it has no area or crosses itself.
std::vector<int> cutPolygon(const Points& corners);

}  // namespace scree
