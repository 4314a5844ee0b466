// Poses of many copies of one body as a text file: a line "x y z qw qx qy qz" for each, lengths in
// the shot's unit. What follows # is a comment; empty lines count for nothing.
#pragma once

#include <string>
#include <vector>

#include "core/math/types.h"
#include "io/problem_list.h"

namespace scree {

/// Orientations are normalised. Problems inside the file are reported at their own line and column,
/// at most twenty; a file that cannot be read is reported at `where`, the place that named it.
std::vector<Pose> readPoseFile(const std::string& path, const SourceLocation& where,
                               ProblemList& problems);

/// The file that holds these poses, all their digits kept; `comment` is one line at its head.
std::string encodePoseFile(const std::vector<Pose>& poses, const std::string& comment);

/// The quaternion w x y z normalised, or the identity and false when it is too short to have a
/// direction.
bool toOrientation(double w, double x, double y, double z, Quat& orientation);

}  // namespace scree
