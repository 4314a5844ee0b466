// A solid from a mesh that bounds none: holes, sheets, parts that pierce each other. Only on
// demand: what collides is then no longer exactly what is drawn, and by how much is told.  [A1]
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

enum class MeshRepair {
    none,      ///< refuse a mesh that is no solid
    wrap,      ///< the solid around which the mesh winds more than half: closes holes, joins parts
    shell,     ///< everything within half a thickness of the mesh
    ground,    ///< what lies below an open sheet: ground_solid.h
    room,      ///< the walls around a closed mesh that is seen from inside: room_solid.h
    solidify,  ///< an open sheet with a thickness behind it: solidified_sheet.h
};

struct RemeshSettings {
    MeshRepair repair = MeshRepair::none;
    double thickness = 0.0;  ///< of the shell [m]
    double voxel = 0.0;      ///< of the lattice the new surface is drawn on [m]
};

/// Closed, manifold and outward. Sharp edges are rounded by about a voxel, and what is nearly flat
/// has few triangles. The result does not depend on the number of threads. Throws Error{badInput}
/// naming `name` when the mesh cannot be read as a surface at all, when nothing remains (faces that
/// disagree about what is outside), or when the lattice would be finer than 256 voxels along the
/// longest edge.
TriMesh remeshSolid(const TriMesh& mesh, const RemeshSettings& settings, const std::string& name);

}  // namespace scree
