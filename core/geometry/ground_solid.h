// A solid from an open sheet that is seen from one side, such as a terrain.  [A1]
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

struct GroundSolid {
    TriMesh mesh;  ///< its first triangles are those of the sheet
    Vec3 up;       ///< the axis that the sheet looks along
    double depth;  ///< of the floor below the lowest point of the sheet [m]
};

/// Closes the sheet by walls from its rim straight down, and by a floor: what touches it touches
/// what is drawn, to the last bit. `depth` [m]; 0: a tenth of the longest edge. Parts that are
/// closed stay as they are. Throws Error{badInput} naming `name` when nothing is open, when the
/// faces look to all sides alike, or when what comes out is no solid.
GroundSolid closeBelow(const TriMesh& sheet, double depth, const std::string& name);

}  // namespace scree
