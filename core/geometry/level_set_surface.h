// The surface of a solid that is given by a function: how generated assets get their meshes.
#pragma once

#include <functional>

#include "core/geometry/tri_mesh.h"
#include "core/math/aabb.h"

namespace scree {

/// Triangles of the surface where `phi` is zero, outward oriented, one point to about every
/// `spacing` [m]. `phi` is negative inside, continuous, and grows away from the surface about as
/// fast as distance does; nothing of the solid may reach out of `box`. Empty when there is no
/// surface. Details finer than two spacings are lost or torn: ask findDefects().
TriMesh surfaceOf(const std::function<double(const Vec3&)>& phi, const Aabb& box, double spacing);

}  // namespace scree
