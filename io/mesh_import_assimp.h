// Mesh files through assimp, for the process that mesh_import.h confines: what comes out is not
// validated here. assimp stores coordinates as float, so an OBJ written with more digits loses
// them: an error of 6e-8 of the coordinate, which is below what modelling packages keep themselves.
#pragma once

#include <cstdint>
#include <string>

#include "io/mesh_import.h"

namespace scree {

/// Reads a file with the loaders of one ending only: a stranger's file does not choose its parser.
/// Opens files in its folder and below, for reading. Throws Error{badInput} with a reason that
/// "… cannot be read: " may stand before, also for nodes nested in more than `mostDepth` others.
ImportedFile importWithAssimp(const std::string& path, const std::string& ending,
                              std::uint32_t mostDepth);

}  // namespace scree
