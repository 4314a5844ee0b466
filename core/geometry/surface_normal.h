// The normal of a body's surface for a contact at a point on or near it.  [A5, A6]
#pragma once

#include "core/geometry/shape.h"

namespace scree {

/// Unit outward normal of `shape` for a contact at `point`, object frame. `approach` is the
/// velocity of the other body's point relative to this shape, object frame [m/s]: at an edge it
/// tells which of the faces is being run into.
///
/// Smooth shapes answer with the gradient of the field. Sharp ones cast a ray along that gradient
/// and answer with the mesh's own normal where it leaves (or, from outside, meets) the surface.
Vec3 surfaceNormal(const Shape& shape, const Vec3& point, const Vec3& approach);

}  // namespace scree
