// Mesh files → TriMesh, as the artist made them: nothing is repaired, rescaled or recentred.
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// All meshes of a file as one, where its nodes place them; polygons are cut into triangles and
/// equal points joined, lengths as in the file. Coordinates pass through single precision. Whether
/// the result is a solid is not asked here. Throws Error{missingInput} when there is no such file,
/// and Error{badInput} for an unsupported file ending, an unreadable file, one without faces and
/// one with coordinates that are not finite.
TriMesh importMesh(const std::string& path);

}  // namespace scree
