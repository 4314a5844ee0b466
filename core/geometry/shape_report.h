// What can be told of a shape before it is simulated.
#pragma once

#include "core/geometry/shape.h"

namespace scree {

struct ShapeReport {
    std::size_t triangles = 0, points = 0;  ///< of what collides
    int parts = 0;                          ///< that share no point; cavities count
    double meshVolume = 0.0;                ///< [m³]
    double fieldVolume = 0.0;   ///< where the field is negative [m³]; equal but for its voxels
    double sharpestEdge = 0.0;  ///< angle between the normals of two faces [rad]
    int sharpEdges = 0;         ///< of more than 40°  [A6]
    double longestEdge = 0.0;   ///< of its box [m]
};

/// Not of a plane.
ShapeReport reportShape(const Shape& shape);

}  // namespace scree
