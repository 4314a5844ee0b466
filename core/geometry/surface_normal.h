// The normal of a body's surface for a contact at a point on or near it.  [A5, A6]
#pragma once

#include "core/geometry/shape.h"

namespace scree {

/// How a point of another body comes to touch a shape, all in the shape's object frame.
struct Approach {
    Vec3 point;     ///< where the normal is wanted [m]
    Vec3 velocity;  ///< of the point relative to the shape [m/s]
    Vec3 from, to;  ///< where the point is before the step and where it is predicted to be [m]
};

/// Unit outward normal of `shape`, object frame.
///
/// Smooth shapes answer with the gradient of the field. Sharp ones answer with the mesh: the face
/// that the point crosses on its way, or, if it crosses none (it is inside already, or will stop
/// short), the face that a ray along the gradient meets.
Vec3 surfaceNormal(const Shape& shape, const Approach& approach);

}  // namespace scree
