// [[import]]: the nodes of a file that a shot asks for, placed in its world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

struct PlacedNode {
    std::string name;             ///< identifier made of the node's name; may repeat
    NodeSpec shape;               ///< nodes that show the same mesh share it
    Pose worldFromNode;           ///< [m]
    std::vector<MotionKey> keys;  ///< of a keyed import, at least one
    KeyInterpolation interpolation = KeyInterpolation::linear;
};

/// The nodes of a checked [[import]] that one of its patterns fits, in the order of the file.
/// Reports a file that cannot be read, every pattern that fits nothing, and motion = "keyed" where
/// nothing moves or cannot move so.
std::vector<PlacedNode> readImportedNodes(const ShotNode& node, const std::string& path,
                                          const Shot& shot, ProblemList& problems);

/// The camera of a checked [[camera]] with a `file`: the first of the file's that its `node` fits,
/// lengths in metres, with a key for every frame of the shot where it moves. Reports what hinders
/// it, and then gives nothing.
std::optional<SceneCamera> readImportedCamera(const ShotNode& node, const std::string& path,
                                              const Shot& shot, ProblemList& problems);

}  // namespace scree
