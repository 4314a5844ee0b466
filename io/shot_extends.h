// One shot on top of another: what `extends` means.
#pragma once

#include <filesystem>

#include "io/shot_tree.h"

namespace scree {

/// `over` laid over `base`: tables key by key, lists of named tables ([[body]]) name by name, all
/// else replaced. A key of `over` also removes what it cannot stand beside, so that an orientation
/// replaces a rotation.
ShotNode laidOver(ShotNode base, const ShotNode& over);

/// Makes file names in a tree that stands in `folder`, relative to the shot that extends it, hold
/// for that shot.
void rebaseFiles(ShotNode& tree, const std::filesystem::path& folder);

}  // namespace scree
