// Two bodies where they are, as the narrow phases of both methods are asked about them.
#pragma once

#include "core/geometry/shape.h"

namespace scree {

/// Two bodies, placed. Pointers only borrow.
struct PlacedPair {
    const Shape* shapeA;
    const Shape* shapeB;
    Pose worldFromA, worldFromB;
};

}  // namespace scree
