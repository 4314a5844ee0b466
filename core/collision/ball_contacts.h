// Where a ball touches: every place of the other surface to which the ball is nearer than to
// all that surrounds the place.  [A9; algorithm 14]
//
// Of a convex solid there is one such place, and the distance field of the solid tells it. Of a
// hollow one there may be several: a ball that falls between the legs of a letter R touches both,
// and told of the nearer one alone it was pressed an eighth of its size into the other. Nor can the
// lattice tell even that one, for the centre of a large ball lies outside of it (SignedDistance::
// gridValue): the triangles must.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/collision/relative_pair.h"
#include "core/math/ball.h"

namespace scree {

/// One of the places where a ball touches.
struct BallContact {
    /// What of the other surface it is: a triangle and 0, or the two ends of an edge, or a corner
    /// twice, corners counted from 1.
    std::array<std::int32_t, 2> place;
    FeatureContact contact;
};

/// Of a ball in the frame of a shape all contacts with gaps below `reach` [m], ordered by place.
void findBallContacts(const Ball& ball, const Shape& surface, double reach,
                      std::vector<BallContact>& found);

}  // namespace scree
