// What cameras are called in exports, where they stand beside bodies of the same name.
#pragma once

#include <string>
#include <vector>

#include "core/picture/scene_description.h"

namespace scree {

/// A name for each camera of the scene, the same in every format: its own where no body and no
/// group that a format makes is called so, else with _2, _3, … behind it. Bodies keep theirs.
std::vector<std::string> cameraNames(const SceneDescription& scene);

}  // namespace scree
