// Where a table of a shot puts something: `position`, and `rotation` or `orientation`. The same
// words for bodies, keys, imports and cameras of files.
#pragma once

#include "core/math/types.h"
#include "io/problem_list.h"
#include "io/shot_tree.h"

namespace scree {

/// Lengths in the shot's unit; the identity where the table says nothing. Reports an orientation
/// that is zero.
Pose readPose(const ShotNode& node, ProblemList& problems);

}  // namespace scree
