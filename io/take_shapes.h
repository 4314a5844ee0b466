// The meshes that a take keeps under shapes/: all but those of planes, which are as large as the
// action.
#pragma once

#include <filesystem>
#include <vector>

#include "core/picture/scene_description.h"
#include "io/take_folder.h"
#include "io/take_info.h"

namespace scree {

/// What take.json is to say of them.
std::vector<TakeShape> shapesOf(const SceneDescription& scene);

/// Those that are there already are compared: a name says nothing of what a file holds. Answers
/// which held something else.
std::vector<std::filesystem::path> writeShapes(const TakePaths& paths,
                                               const SceneDescription& scene);

}  // namespace scree
