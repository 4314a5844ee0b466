// [shape.NAME]: from what a shape is made, and how its field, normals and samples are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/problem_list.h"
#include "io/shot.h"
#include "io/shot_tree.h"

namespace scree {

/// Appends the shapes of a checked shot to shot.shapes; files are found in `folder`. `isStrict`:
/// all collide by the sampled field alone. Returns the names of all shapes, those that are wrong
/// too, so that nobody who refers to one is told that it is not there.
std::vector<std::string> readShapes(const ShotNode& tree, const std::filesystem::path& folder,
                                    bool isStrict, Shot& shot, ProblemList& problems);

/// Reads `sdf`, `field`, `normals`, `edge_samples` and `mesh` of a checked [shape.NAME], or of an
/// [[import]], which has them for all of its shapes; reports what fits badly.
ShapeSettings readShapeSettings(const ShotNode& node, bool isStrict, double metresPerUnit,
                                ProblemList& problems);

}  // namespace scree
