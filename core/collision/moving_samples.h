// Samples of round bodies, which are no material points: where such a body is deepest moves over
// its surface as it rolls.  [A9, A40]
//
// The material point that will touch next lies ahead of the contact by the step's travel, and the
// normal impulse there brakes: a ball of 0.5 m at 2 m/s loses a third of its speed in 6 s. So an
// exact sphere or cylinder has its deepest points computed for each configuration anew, and the
// sample of a fine mesh slides to the foot point of the smooth surface the mesh stands for.
#pragma once

#include <vector>

#include "core/collision/interference.h"
#include "core/collision/relative_pose.h"

namespace scree {

/// Appends the samples of a body whose samples move (Shape::samplesMove) at less than tau from the
/// other: of a sphere its deepest point; of a cylinder the deepest point of each rim, the
/// deepest point of the side between, and eight fixed points of each rim, on which it stands.
void findMovingTouches(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                       double tau, bool sampleOnA, std::vector<Touch>& touches);

/// The same sample with the pair placed otherwise, in the frame of its body; its own point where
/// the deepest one is so far away that it cannot have rolled there.
Vec3 movingSample(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                  const Touch& touch);

/// The sample of a fine smooth mesh slid along its surface to where the other body is nearest;
/// `normal` is that of the other body at the sample, in its own frame. The point itself where the
/// mesh is sharp or coarse, or where the way there leads uphill.  [A40]
///
/// Departs from A40 in what it slides on. On the flat facets the lowest point is always a corner,
/// and a ball of 1280 triangles then pivots from corner to corner like the polyhedron it is; on
/// interpolated normals it is the foot point, and the ball rolls.
Vec3 slidSample(const Shape& sampled, const Shape& field, const FieldFromSamples& pose,
                const Touch& touch, const Vec3& normal);

}  // namespace scree
