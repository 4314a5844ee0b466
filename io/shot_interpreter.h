// Tree → Shot: gives the values of a shot file their meaning. Lengths become metres, angles
// radians, names are looked up, grids and pose files become bodies.
#pragma once

#include <string>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// `tree` has been checked and completed (shot_check.h). Problems that need more than one key are
/// reported; where a value was already found wrong, nothing more is said of it. Files are found
/// beside `shotPath`; imports are read within `limits`.
Shot interpretShot(const ShotNode& tree, const std::string& shotPath, const ImportLimits& limits,
                   ProblemList& problems);

}  // namespace scree
