// How the process that reads a foreign file (mesh_import.h) hands over what it found. Whoever
// takes it believes none of it.
#pragma once

#include <string>

#include "io/mesh_import.h"

namespace scree {

std::string encodeImport(const ImportedFile& file);

/// What was encoded. Throws Error{badInput} that names `path`
/// for bytes that are cut, and for what no file may hold: too much of something, corners that are
/// no points, numbers that are not finite, keys out of order.
ImportedFile decodeImport(const std::string& bytes, const std::string& path,
                          const ImportLimits& limits = {});

}  // namespace scree
