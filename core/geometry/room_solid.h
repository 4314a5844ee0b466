// A solid from a closed mesh that is seen from inside, such as a room.  [A1]
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

struct RoomSolid {
    TriMesh mesh;  ///< its first triangles are those of the room
    double wall;   ///< at its thinnest [m]
};

/// Puts a box around a room, so that what touches the room from inside touches what is drawn, to
/// the last bit. `wall` [m]; 0: a tenth of the longest edge. Throws Error{badInput} naming `name`
/// when the faces do not look inward, or when what comes out is no solid.
RoomSolid wallAround(const TriMesh& room, double wall, const std::string& name);

}  // namespace scree
