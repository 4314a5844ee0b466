// What the nodes of a file show and where they go, once assimp has opened it: their meshes, cameras
// and keys.
#pragma once

#include <cstdint>

#include "io/fbx_lens.h"
#include "io/gltf_reading.h"
#include "io/mesh_import.h"

struct aiScene;

namespace scree {

/// Fills the nodes and cameras of `file` in. `gltf` and `fbx` are null of other files. Throws
/// Error{badInput} as mesh_import_assimp.h does.
void readNodes(const aiScene& scene, const GltfReading* gltf, const FbxLens* fbx,
               std::uint32_t mostDepth, ImportedFile& file);

}  // namespace scree
