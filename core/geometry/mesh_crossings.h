// Where the faces of a mesh pierce each other.
#pragma once

#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

struct MeshCrossing {
    int triangle = -1;          ///< the one that is pierced
    Vec3 place = Vec3::Zero();  ///< where an edge of another goes through it
};

/// Every edge that goes through a triangle, of which its own have no point, by more than a millionth
/// of the mesh's diagonal: coordinates are stored in single precision, and faces that merely touch
/// are no crossing. One entry for each triangle and edge, in a fixed order; of several triangles
/// that border on each other there, for each.
std::vector<MeshCrossing> findCrossings(const TriMesh& mesh);

}  // namespace scree
