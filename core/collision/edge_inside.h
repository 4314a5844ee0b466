// How near an edge of a body comes to another, and how deep it lies there. Fields are asked along
// it, as far apart as they say that nothing can be met; where rays say that it is outside, not at
// all.  [A8]
#pragma once

#include "core/collision/relative_pair.h"

namespace scree {

/// Whether an edge of the first comes within `reach` of the second [m].
bool comesWithin(const RelativePair& pair, const ConvexEdge& edge, double reach);

/// How deep an edge of the first lies in the second, about [m]; where nothing of it is below
/// `enough` < 0, some value that is not either.
double deepestAlong(const RelativePair& pair, const ConvexEdge& edge, double enough);

}  // namespace scree
