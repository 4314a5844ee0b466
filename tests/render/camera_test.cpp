#include "render/camera.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double kAspect = 16.0 / 9.0;

Vec3 clipped(const Camera& camera, const DepthRange& range, const Vec3& world)
{
    const Eigen::Vector4d clip =
        clipFromView(camera, kAspect, range) * viewFromWorld(camera) * world.homogeneous();
    return clip.hnormalized();
}

Camera sampleCamera()
{
    Camera camera;
    camera.eye = {16, 12, 20};
    camera.target = {0, 3, 0};
    return camera;
}

TEST(Camera, TargetIsInTheMiddleOfThePicture)
{
    const Camera camera = sampleCamera();
    const Vec3 clip = clipped(camera, {1.0, 100.0}, camera.target);
    EXPECT_NEAR(clip.x(), 0.0, 1e-12);
    EXPECT_NEAR(clip.y(), 0.0, 1e-12);
}

TEST(Camera, FieldOfViewIsVertical)
{
    Camera camera;
    camera.eye = {0, 0, 10};
    camera.fovDegrees = 90.0;
    EXPECT_NEAR(clipped(camera, {1.0, 100.0}, {0, 10, 0}).y(), 1.0, 1e-12);
    EXPECT_NEAR(clipped(camera, {1.0, 100.0}, {10, 0, 0}).x(), 1.0 / kAspect, 1e-12);
}

TEST(Camera, DepthRangeMapsToMinusOneAndOne)
{
    Camera camera;
    camera.eye = {0, 0, 10};
    EXPECT_NEAR(clipped(camera, {2.0, 50.0}, {0, 0, 8}).z(), -1.0, 1e-12);
    EXPECT_NEAR(clipped(camera, {2.0, 50.0}, {0, 0, -40}).z(), 1.0, 1e-12);
}

TEST(Camera, LookingAlongItsUpDirectionStillSees)
{
    Camera camera;
    camera.eye = {0, 10, 0};
    const Mat4 view = viewFromWorld(camera);
    const Mat3 axes = view.topLeftCorner<3, 3>();
    EXPECT_TRUE((axes * axes.transpose()).isIdentity(1e-12));
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
}

TEST(FrameAll, AllCornersAreInsideAndOneIsNearTheBorder)
{
    Aabb box;
    box.include({-3, 0, -2});
    box.include({9, 4, 1});
    const Camera camera = frameAll(box, threeQuarterView(false), Vec3::UnitY(), kAspect);
    double widest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 world((corner & 1) ? box.max.x() : box.min.x(),
                         (corner & 2) ? box.max.y() : box.min.y(),
                         (corner & 4) ? box.max.z() : box.min.z());
        const Vec3 clip = clipped(camera, {0.1, 1000.0}, world);
        widest = std::max({widest, std::abs(clip.x()), std::abs(clip.y())});
    }
    EXPECT_LT(widest, 1.0);
    EXPECT_GT(widest, 0.9);  // the margin is 8 %
}

}  // namespace
}  // namespace scree
