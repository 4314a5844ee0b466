// Points inside a solid, and the largest ball that fits into it.
#pragma once

#include "core/geometry/signed_distance.h"
#include "core/geometry/tri_mesh.h"
#include "core/math/ball.h"

namespace scree {

/// 3×n [m]: a point below every corner of a closed mesh, half the solid's thickness [m] deep.
Points pointsInside(const TriMesh& mesh, double thickness);

/// A ball about as large as any that fits into the solid: the best about those points and the
/// centre of mass, the frame's origin, moved until no place around it is better.
Ball largestBallInside(const TriMesh& mesh, const SignedDistance& distance, double thickness);

}  // namespace scree
