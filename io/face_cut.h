// Faces of mesh files as triangles.
#pragma once

#include <string>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// A face that cannot be cut into triangles.
struct UncutFace {
    explicit UncutFace(const Points& corners);
    std::string why;  ///< "a face of …"
};

/// Its triangles as cutPolygon answers them; throws UncutFace when there are none.
std::vector<int> cutFace(const Points& corners);

}  // namespace scree
