// What is shown of a plane, which has no end: a square of it.
#pragma once

#include <string>

#include "core/picture/scene_description.h"

namespace scree {

/// A square in the plane y = 0 of its own frame, seen from +y, its centre at the origin.
SceneMesh makePlaneMesh(const std::string& name, double halfWidth);

}  // namespace scree
