// How near an edge of a body comes to another, and how deep it lies there: by marching along it as
// far as the field says that nothing can be met.  [A8]
#pragma once

#include "core/collision/relative_pair.h"

namespace scree {

/// Whether an edge of the first comes within `reach` of the second [m].
bool comesWithin(const RelativePair& pair, const ConvexEdge& edge, double reach);

/// How deep an edge of the first lies in the second, about [m]: of where it may dip in `near` is
/// one place [m from its start], others are looked for. Where nothing is below `enough`, some value
/// that is not.
double deepestAlong(const RelativePair& pair, const ConvexEdge& edge, double enough);

}  // namespace scree
