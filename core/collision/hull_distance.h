// How far apart the convex hulls of two bodies are. What is apart by its hull touches nowhere,
// whatever its features look like to each other.  [GJK88]
#pragma once

#include "core/collision/relative_pair.h"

namespace scree {

/// Whether the hulls of a pair have few enough corners that asking for their distance is worth
/// while: those of a ring take as long as its features.
bool areHullsSmall(const RelativePair& pair);

/// Lower bound of the distance between the hulls, of shapes with corners [m]; not above zero where
/// they overlap.
double hullsApart(const RelativePair& pair);

/// The corner of a shape with corners that lies farthest along a direction [m].
Vec3 supportOf(const ContactFeatures& features, const Vec3& direction);

}  // namespace scree
