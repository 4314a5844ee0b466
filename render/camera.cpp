// View and projection matrices, and framing.
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/picture/camera_motion.h"

namespace scree {
namespace {

constexpr double kFrameMargin = 1.08;  // free border around a framed box

/// On each side of the picture this share of many may be out of it, if what is left is seen so many
/// times as large.
constexpr double kFew = 0.02, kMuchLarger = 2.0;

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

Framing::Framing(const Vec3& towardEye, const Vec3& up, double aspect, double fovDegrees)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    camera_.fovDegrees = fovDegrees;
    camera_.up = up;
    viewFromWorldAxes_ = worldFromViewAxes(towardEye, Vec3::Zero(), up).transpose();
    tanY_ = tanHalfFov(camera_) / kFrameMargin;
    tanX_ = tanY_ * aspect;
    right_ = left_ = top_ = bottom_ = nearest_ = -kInfinity;
    farthest_ = kInfinity;
}

void Framing::include(const Vec3& point)
{
    const Vec3 view = viewFromWorldAxes_ * point;
    right_ = std::max(right_, view.z() * tanX_ + view.x());
    left_ = std::max(left_, view.z() * tanX_ - view.x());
    top_ = std::max(top_, view.z() * tanY_ + view.y());
    bottom_ = std::max(bottom_, view.z() * tanY_ - view.y());
    nearest_ = std::max(nearest_, view.z());
    farthest_ = std::min(farthest_, view.z());
}

void Framing::include(const Aabb& box)
{
    for (int corner = 0; corner < 8; ++corner) {
        include(Vec3((corner & 1) ? box.max.x() : box.min.x(),
                     (corner & 2) ? box.max.y() : box.min.y(),
                     (corner & 4) ? box.max.z() : box.min.z()));
    }
}

void Framing::include(const Framing& other)
{
    right_ = std::max(right_, other.right_);
    left_ = std::max(left_, other.left_);
    top_ = std::max(top_, other.top_);
    bottom_ = std::max(bottom_, other.bottom_);
    nearest_ = std::max(nearest_, other.nearest_);
    farthest_ = std::min(farthest_, other.farthest_);
}

void Framing::includeMost(const std::vector<Framing>& each)
{
    const auto few = static_cast<std::size_t>(kFew * static_cast<double>(each.size()));
    std::vector<char> isOut(each.size(), 0);
    for (const auto side : {&Framing::right_, &Framing::left_, &Framing::top_, &Framing::bottom_}) {
        std::vector<double> sides;
        for (const Framing& one : each) sides.push_back(one.*side);
        std::ranges::sort(sides, std::greater());
        for (std::size_t i = 0; i < each.size(); ++i) isOut[i] |= each[i].*side > sides[few];
    }
    Framing all = *this, most = *this;
    for (std::size_t i = 0; i < each.size(); ++i) {
        all.include(each[i]);
        if (!isOut[i]) most.include(each[i]);
    }
    const auto distance = [](const Camera& view) { return (view.eye - view.target).norm(); };
    const bool isMuchLarger = distance(all.camera()) > kMuchLarger * distance(most.camera());
    *this = isMuchLarger && !most.isEmpty() ? most : all;
}

// A point at (x, y, z) is inside the right side of the picture of an eye at (a, b, c) when
// x - a <= (c - z) tan, which is c tan + a >= z tan + x, and inside the left one when
// c tan - a >= z tan - x: the sum of both bounds c, their difference gives a.
Camera Framing::camera() const
{
    Vec3 eye = Vec3::Zero();
    double middle = -1.0;
    if (!isEmpty()) {
        eye << 0.5 * (right_ - left_), 0.5 * (top_ - bottom_),
            std::max(0.5 * (right_ + left_) / tanX_, 0.5 * (top_ + bottom_) / tanY_);
        // Things in one line with the eye hide each other, but are in front of it.
        const double depth = nearest_ - farthest_;
        eye.z() = std::max(eye.z(), nearest_ + 0.1 * depth);
        middle = 0.5 * (nearest_ + farthest_);
        if (eye.z() == middle) eye.z() += 1.0;  // all that is seen is one point
    }
    Camera camera = camera_;
    camera.eye = viewFromWorldAxes_.transpose() * eye;
    camera.target = viewFromWorldAxes_.transpose() * Vec3(eye.x(), eye.y(), middle);
    return camera;
}

Vec3 threeQuarterView(bool zUp)
{
    return zUp ? Vec3(0.58, -0.70, 0.42) : Vec3(0.58, 0.42, 0.70);
}

}  // namespace scree
