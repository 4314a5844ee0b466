// Where a round part of a mesh faces a given way: the question that facets and rims are asked.
// [A40]
#pragma once

#include "core/math/types.h"

namespace scree {

struct RoundPlace {
    Vec3 point;    ///< on its facet or edge [m]
    double bulge;  ///< how far the round surface lies above the mesh there, that way [m]
    Mat3 advance;  ///< what it moves by when that way turns [m/rad]
    /// It is where a side begins that bends one way only, and the way leans over that.
    bool isPastEnd = false;
};

/// What came of a search. `elsewhere`: it is more than a few facets or edges away; `onSide`:
/// between lies a side that bends one way only; `notRound`: what is there is not round, or does not
/// bend.
enum class RoundSearch { found, elsewhere, onSide, notRound };

/// A mesh stands for something round where it turns by no more than 20° at a time (this is the
/// cosine, and a little less for rounding). Beyond, as on a ring of ten points around its tube
/// (36°), a facet lies flat on the ground and holds the body: taken for round it would roll off.
inline constexpr double kFineTurn = 0.93969;

}  // namespace scree
