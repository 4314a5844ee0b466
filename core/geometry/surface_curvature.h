// How strongly a surface bends at a point, from its distance field.  [A50]
#pragma once

#include "core/geometry/shape.h"

namespace scree {

/// Mean curvature ½ ∇·N [1/m] at a point on or near the surface, object frame: positive where the
/// solid is convex, 1/R on a sphere, 0 on flat faces. Sharp edges answer with the largest that the
/// field's spacing resolves.
double meanCurvature(const Shape& shape, const Vec3& point);

/// The same from a sixth of the samples; it jumps a little from one cell of the field to the next.
double meanCurvatureOfCells(const Shape& shape, const Vec3& point);

}  // namespace scree
