// Fewer triangles for the same surface, by collapsing edges.
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree {

/// `mesh` with exactly `triangleCount` triangles (even), still closed and of the same genus, its
/// points among the old ones. Edges go in the order in which their quadric error is least
/// (Garland and Heckbert 1997); no face turns over. Throws Error{badInput} when the mesh is not
/// manifold or cannot be brought down so far.
TriMesh decimated(const TriMesh& mesh, int triangleCount);

/// The same with as few triangles as leave every old point within `tolerance` of the new surface
/// [m].
TriMesh decimatedWithin(const TriMesh& mesh, double tolerance);

}  // namespace scree
