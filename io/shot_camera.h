// A camera of a shot: standing still, keyed, or on an orbit.
#pragma once

#include <filesystem>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// `node` is a checked and completed [[camera]]; of `shot`, frames and units must have been read;
/// a file it names is found in `folder`.
/// Eye, target and angle of view of a camera that moves are those of the first frame.
SceneCamera interpretCamera(const ShotNode& node, const std::filesystem::path& folder,
                            const Shot& shot, ProblemList& problems);

}  // namespace scree
