// Where all bodies of a scene stand, as one JSON file for scripts.
#pragma once

#include <string>

#include "core/picture/scene_description.h"

namespace scree {

/// {"scene", "metres_per_unit", "up", "frame", "bodies": [{"name", "mesh", "position": [x, y, z],
/// "orientation": [w, x, y, z]}]}: poses of the artist's own frames in the shot's unit, numbers
/// with all their digits.
std::string encodePoses(const SceneDescription& scene, const SceneFrame& frame);

}  // namespace scree
