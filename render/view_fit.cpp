// Depth ranges and light frusta.
#include "render/view_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {
namespace {

// nearest / farthest is never smaller. With a hundredth of it, and 32 bits, corners in single
// precision speckled coins while another rolled past the eye.
constexpr double kNearestShare = 1e-4;
constexpr double kSizeStepsPerOctave = 4.0;
constexpr int kFewestTexels = 64;

/// Cosine of the angle between the axis and a corner of the picture.
double cosToCorner(const Camera& camera, double aspect)
{
    const double tanY = std::tan(camera.fovDegrees * std::numbers::pi / 360.0);
    return 1.0 / std::sqrt(1.0 + tanY * tanY * (1.0 + aspect * aspect));
}

/// Rows: right and up of the map and the direction towards the light.
Mat3 mapAxes(const Vec3& towardLight)
{
    const Vec3 backward = towardLight.normalized();
    const Vec3 right = backward.unitOrthogonal();
    Mat3 axes;
    axes << right.transpose(), backward.cross(right).transpose(), backward.transpose();
    return axes;
}

}  // namespace

DepthRange fitDepth(const Camera& camera, double aspect, const std::vector<Ball>& bodies,
                    const std::vector<PlaneSurface>& planes, double reach)
{
    const Mat4 view = viewFromWorld(camera);
    DepthRange range{reach, reach};
    for (const Ball& ball : bodies) {
        const double depth = -(view.row(2).head<3>().dot(ball.centre) + view(2, 3));
        if (depth + ball.radius <= 0.0) continue;  // behind the camera
        range.nearest = std::min(range.nearest, depth - ball.radius);
        range.farthest = std::max(range.farthest, depth + ball.radius);
    }
    for (const PlaneSurface& plane : planes) {
        const double height = plane.normal.dot(camera.eye - plane.point);
        if (height <= 0.0) continue;  // seen from inside the solid: not drawn
        range.nearest = std::min(range.nearest, height * cosToCorner(camera, aspect));
    }
    range.farthest *= 1.001;
    range.nearest = std::max(0.999 * range.nearest, kNearestShare * range.farthest);
    return range;
}

Points visibleCorners(const Camera& camera, double aspect, const DepthRange& range)
{
    const Mat4 worldFromClip =
        (clipFromView(camera, aspect, range) * viewFromWorld(camera)).inverse();
    Points corners(3, 8);
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector4d clip(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0, 1.0);
        corners.col(i) = (worldFromClip * clip).hnormalized();
    }
    return corners;
}

DepthMapFit fitDepthMap(const Vec3& towardLight, const std::vector<Ball>& casters,
                        const Points& visible, double margin, double wantedTexel, int mostTexels)
{
    // Bound the casters in the axes of the map.
    const Mat3 axes = mapAxes(towardLight);
    Aabb bounds;
    for (const Ball& ball : casters) {
        const Vec3 centre = axes * ball.centre;
        bounds.include(Aabb{centre, centre}.grown(ball.radius + margin));
    }
    if (bounds.isEmpty() || !(bounds.diagonal() > 0.0))
        bounds = {-Vec3::Ones(), Vec3::Ones()};  // nothing to hold

    // Leave out what is to the side of all that is seen; what is in front of it may cast shadows.
    Aabb seen;
    for (Eigen::Index i = 0; i < visible.cols(); ++i) seen.include(Vec3(axes * visible.col(i)));
    const Aabb wide = seen.grown(margin);
    if (visible.cols() > 0 && wide.overlaps(bounds)) {
        bounds.min.head<2>() = bounds.min.head<2>().cwiseMax(wide.min.head<2>());
        bounds.max.head<2>() = bounds.max.head<2>().cwiseMin(wide.max.head<2>());
    }

    // Choose the texel from a geometric row of sizes, and put the middle on a corner of texels.
    DepthMapFit fit;
    const double halfEdge = 0.5 * std::max(bounds.size().x(), bounds.size().y());
    const double finest = std::max(
        {wantedTexel, 2.0 * halfEdge / (mostTexels - 4), std::numeric_limits<double>::min()});
    fit.texel = std::exp2(std::ceil(kSizeStepsPerOctave * std::log2(finest)) / kSizeStepsPerOctave);
    fit.size = std::clamp(static_cast<int>(std::ceil(2.0 * halfEdge / fit.texel)) + 4,
                          std::min(kFewestTexels, mostTexels), mostTexels);
    fit.size += fit.size % 2;
    const Vec3 middle = (bounds.centre().array() / fit.texel).floor() * fit.texel;

    // Map x and y to -1 … 1 and depth from the light's side to the far side to -1 … 1.
    fit.depth = std::max(bounds.size().z(), fit.texel);
    const double scale = 2.0 / (fit.size * fit.texel), depthScale = -2.0 / fit.depth;
    fit.clipFromWorld.topLeftCorner<3, 3>() = axes;
    fit.clipFromWorld.topRows<2>() *= scale;
    fit.clipFromWorld.row(2) *= depthScale;
    fit.clipFromWorld(0, 3) = -scale * middle.x();
    fit.clipFromWorld(1, 3) = -scale * middle.y();
    fit.clipFromWorld(2, 3) = -depthScale * bounds.max.z() - 1.0;
    return fit;
}

}  // namespace scree
