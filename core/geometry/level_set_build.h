// The one door to OpenVDB for fields: a closed mesh becomes signed distances at the nodes of a
// lattice.  [A4]
#pragma once

#include "core/geometry/distance_nodes.h"
#include "core/geometry/surface_rays.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// The distance is that to the closest triangle; OpenVDB finds, by flooding, which side every node
/// is on, and which blocks are near the surface. In a mesh of several parts, and where it finds
/// that the flood has not reached all, the winding number says which of what is not outside is
/// solid and which a cavity. `automatic` decides between the storages by what they would take. The
/// result does not depend on the number of threads.
DistanceNodes buildDistanceNodes(const TriMesh& mesh, const SurfaceRays& rays,
                                 const NodeLayout& layout, FieldStorage storage);

}  // namespace scree
