// Sets and rigid motion from an Alembic file: every polygon mesh with the transforms above it.
//
// Read are PolyMesh objects (points, faces, texture coordinates) and Xform objects over time, also
// where instances repeat them. Refused once they are chosen, because it would be seen: faces that
// cross themselves, meshes whose points move, scale that changes and subdivision surfaces. Cameras come with their zoom. Passed over: curves, points, lights, visibility, and
// everything in properties of the user's own.
#pragma once

#include <cstdint>
#include <string>

#include "io/mesh_import.h"

namespace scree {

/// Nodes are called after the transform above their mesh. Times are those of the file, where frame
/// n stands at n / rate seconds by custom. For the process that
/// mesh_import.h confines; throws Error{badInput} with a reason that "… cannot be read: " may stand
/// before, also for objects in more than `mostDepth` others.
ImportedFile importAlembic(const std::string& path, std::uint32_t mostDepth);

}  // namespace scree
