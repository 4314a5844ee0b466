// View and projection matrices, and framing.
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/camera_motion.h"

namespace scree {
namespace {

constexpr double kFrameMargin = 1.08;  // free border around a framed box

double tanHalfFov(const Camera& camera)
{
    return std::tan(camera.fovDegrees * std::numbers::pi / 360.0);
}

}  // namespace

Mat4 viewFromWorld(const Camera& camera)
{
    const Mat3 viewFromWorldAxes =
        worldFromViewAxes(camera.eye, camera.target, camera.up).transpose();
    Mat4 view = Mat4::Identity();
    view.topLeftCorner<3, 3>() = viewFromWorldAxes;
    view.topRightCorner<3, 1>() = -(viewFromWorldAxes * camera.eye);
    return view;
}

Mat4 clipFromView(const Camera& camera, double aspect, const DepthRange& range)
{
    const double scale = 1.0 / tanHalfFov(camera);
    const double depth = range.farthest - range.nearest;
    Mat4 clip = Mat4::Zero();
    clip(0, 0) = scale / aspect;
    clip(1, 1) = scale;
    clip(2, 2) = -(range.farthest + range.nearest) / depth;
    clip(2, 3) = -2.0 * range.farthest * range.nearest / depth;
    clip(3, 2) = -1.0;
    return clip;
}

Camera frameAll(const Aabb& box, const Vec3& towardEye, const Vec3& up, double aspect,
                double fovDegrees)
{
    Camera camera;
    camera.fovDegrees = fovDegrees;
    camera.up = up;
    camera.target = box.isEmpty() ? Vec3(Vec3::Zero()) : box.centre();
    camera.eye = camera.target + towardEye;
    if (box.isEmpty()) return camera;

    // A corner at (x, y, z) from the target, in view axes, is inside the picture when the eye is at
    // least |x| / tan(half the horizontal field) + z away, and likewise for y.
    const Mat3 viewFromWorldAxes =
        worldFromViewAxes(camera.eye, camera.target, camera.up).transpose();
    const double tanY = tanHalfFov(camera) / kFrameMargin, tanX = tanY * aspect;
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
        const Vec3 view = viewFromWorldAxes * box.size().cwiseProduct(side);
        distance = std::max(
            {distance, std::abs(view.x()) / tanX + view.z(), std::abs(view.y()) / tanY + view.z()});
    }
    if (distance == 0.0) distance = 1.0;  // a box that is one point
    camera.eye = camera.target + distance * viewFromWorldAxes.row(2).transpose();
    return camera;
}

Vec3 threeQuarterView(bool zUp)
{
    return zUp ? Vec3(0.58, -0.70, 0.42) : Vec3(0.58, 0.42, 0.70);
}

}  // namespace scree
