// Where the picture is taken from. Lengths are in the unit of the scene, axes are the scene's.
#pragma once

#include "core/math/aabb.h"
#include "core/math/types.h"

namespace scree {

using Mat4 = Eigen::Matrix4d;

/// View axes: x to the right, y upwards, the camera looks along -z.
struct Camera {
    Vec3 eye = {0.0, 0.0, 10.0};
    Vec3 target = Vec3::Zero();
    Vec3 up = Vec3::UnitY();   ///< which way is up in the picture; need not be at right angles
    double fovDegrees = 35.0;  ///< vertical
};

/// Distances in front of the eye between which things are drawn, 0 < nearest < farthest.
struct DepthRange {
    double nearest = 0.1;
    double farthest = 1000.0;
};

/// Rotation and translation into view axes. A camera that looks along `up`, or nowhere (eye equal
/// to target), still gets an orthonormal frame.
Mat4 viewFromWorld(const Camera& camera);

/// Perspective in OpenGL's convention: the visible volume becomes the cube -1 … 1. `aspect` is
/// width divided by height.
Mat4 clipFromView(const Camera& camera, double aspect, const DepthRange& range);

/// A camera that looks from `towardEye` (any length) at the middle of `box` from just far enough
/// for the whole box to be in the picture with a small margin.
Camera frameAll(const Aabb& box, const Vec3& towardEye, const Vec3& up, double aspect,
                double fovDegrees = 35.0);

/// Direction in which frameAll finds the eye when nobody asked for another: the three-quarter view.
Vec3 threeQuarterView(bool zUp);

}  // namespace scree
