// Where the picture is taken from. Lengths are in the unit of the scene, axes are the scene's.
#pragma once

#include <vector>

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

/// Finds the nearest camera that looks along a given direction and has all it was shown in its
/// picture, with a small margin. It remembers six numbers however much that is: of every point,
/// how far back the eye must be for it to be inside each of the picture's four sides. One box
/// around a whole action would do with less, and leave most of the picture empty where something
/// flies off to one side only.
class Framing {
public:
    /// The eye is found in the direction `towardEye` (any length) from what is seen.
    Framing(const Vec3& towardEye, const Vec3& up, double aspect, double fovDegrees = 35.0);

    void include(const Vec3& point);
    void include(const Aabb& box);
    void include(const Framing& other);  ///< with the same direction, aspect and angle of view
    bool isEmpty() const { return nearest_ < farthest_; }

    /// All of them, or all but the few of many that go so far from the others that hardly anything
    /// would be seen of these: a ball that has gone through a pane of glass rolls on and on.
    void includeMost(const std::vector<Framing>& each);

    /// Looks at the middle of the depth of what is seen.
    Camera camera() const;

private:
    Camera camera_;  // without its place
    Mat3 viewFromWorldAxes_;
    double tanX_, tanY_;  // of half the angles of view, less the margin
    // The largest x + z tan, z tan - x, and likewise for y, in view axes.
    double right_, left_, top_, bottom_;
    double nearest_, farthest_;  // largest and smallest z
};

/// Direction in which the eye is found when nobody asked for another: the three-quarter view.
Vec3 threeQuarterView(bool zUp);

}  // namespace scree
