// Meshes of simple solids, closed and outward, in their own frame with axis +y. They serve shots
// (generated shapes) and tests (closed forms). Lengths in whatever unit the caller uses.
#pragma once

#include <array>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// Box centred at the origin, each face a grid of segments quads, two triangles each.
TriMesh makeBox(const Vec3& size, const std::array<int, 3>& segments);

/// Ring about +y: `segments[0]` cross sections around the axis, `segments[1]` points on each.
TriMesh makeTorus(double majorRadius, double minorRadius, const std::array<int, 2>& segments);

/// Sphere from an icosahedron split `subdivisions` times: 20·4ⁿ triangles, points on the sphere.
TriMesh makeSphere(double radius, int subdivisions);

/// Prism with `sectors` sides, `bands` quads along the height, caps as fans; origin at its centre.
TriMesh makeCylinder(double radius, double height, int sectors, int bands);

/// Cylinder of `height` between two half spheres; `rings` bands per half sphere.
TriMesh makeCapsule(double radius, double height, int sectors, int rings);

}  // namespace scree
