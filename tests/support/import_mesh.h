// A mesh file as one mesh, for tests that need no nodes.
#pragma once

#include <string>

#include "io/mesh_import.h"

namespace scree::test {

/// Throws what importFile and joinedMesh do.
inline TriMesh importMesh(const std::string& path)
{
    return joinedMesh(importFile(path), path);
}

}  // namespace scree::test
