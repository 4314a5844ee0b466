// Keys between the keys of a file. What hangs on a node that turns goes round, while a body whose
// keys are the file's alone goes straight from each to the next: a door that its hinge opens by 90
// degrees, with a key at either end, cut the corner by a third of its width.
#pragma once

#include <functional>
#include <set>
#include <vector>

#include "io/mesh_import.h"

namespace scree {

/// The poses at some moments [s], and as many between them that who goes steadily from each to the
/// next strays by less than a two-hundredth of the way.
std::vector<ImportedKey> keysAlong(const std::set<double>& moments,
                                   const std::function<Pose(double)>& poseAt);

}  // namespace scree
