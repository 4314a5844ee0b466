// One mesh as a binary PLY file (little endian) with its points in full double precision, and the
// texture coordinates of its corners where it has some: how a take keeps its shapes. Any mesh tool
// opens these files; only files of exactly this layout are read back, meshes from elsewhere come
// through io/mesh_import.h.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// The bytes of the file. Equal meshes give equal bytes.
std::string encodePlyMesh(const TriMesh& mesh);

/// The mesh that was written, bit for bit. Throws Error{missingInput} when there is no file, and
/// Error{inputOutput} when it is cut short or otherwise not what encodePlyMesh makes.
TriMesh readPlyMesh(const std::filesystem::path& path);

}  // namespace scree
