// A distance field as data.
#pragma once

#include "core/geometry/distance_nodes.h"
#include "core/geometry/nearest_faces.h"

namespace scree {

/// All of a field that takes time to build.
struct DistanceField {
    DistanceNodes nodes;
    NearestFaces nearest;
};

}  // namespace scree
