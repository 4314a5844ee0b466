#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

/// The largest of |x| and |y| in the picture, 1 at its border, separately for its four sides.
struct Reach {
    double right = -9.0, left = -9.0, top = -9.0, bottom = -9.0;

    Reach(const Camera& camera, const std::vector<Vec3>& points)
    {
        for (const Vec3& point : points) {
            const Vec3 clip = clipped(camera, {0.01, 1000.0}, point);
            right = std::max(right, clip.x());
            left = std::max(left, -clip.x());
            top = std::max(top, clip.y());
            bottom = std::max(bottom, -clip.y());
        }
    }
    double most() const { return std::max({right, left, top, bottom}); }
};

// A ball that hung above one end of a long wall left three quarters of the picture empty: a box
// around both had a corner where nothing was.
TEST(Framing, TheActionFillsThePictureBetweenTwoSides)
{
    const std::vector<Vec3> points = {{-3, 0, 0}, {3, 0, 0}, {-3, 1, 0}, {3, 1, 0}, {0, 6, -9}};
    Framing framing(threeQuarterView(false), Vec3::UnitY(), kAspect);
    for (const Vec3& point : points) framing.include(point);
    const Reach reach(framing.camera(), points);
    constexpr double kBorder = 1.0 / 1.08;  // 8 % margin
    EXPECT_NEAR(reach.most(), kBorder, 1e-9);
    // One pair of opposite sides decides how near the eye can be; of the other, both are as far.
    const bool isWide = std::abs(reach.right - kBorder) < 1e-9;
    EXPECT_NEAR(isWide ? reach.left : reach.bottom, kBorder, 1e-9);
    EXPECT_LT(isWide ? reach.top : reach.right, kBorder);
}

TEST(Framing, CornersOfABoxAreInsideOneNearTheBorder)
{
    const Aabb box{{-3, 0, -2}, {9, 4, 1}};
    Framing framing(threeQuarterView(false), Vec3::UnitY(), kAspect);
    framing.include(box);
    std::vector<Vec3> corners;
    for (const double x : {-3.0, 9.0})
        for (const double y : {0.0, 4.0})
            for (const double z : {-2.0, 1.0}) corners.emplace_back(x, y, z);
    EXPECT_NEAR(Reach(framing.camera(), corners).most(), 1.0 / 1.08, 1e-9);
}

TEST(Framing, APointAndALineAlongTheSightAreInFrontOfTheEye)
{
    const Vec3 towardEye = threeQuarterView(true), point(3, 4, 5);
    for (const double length : {0.0, 2.0}) {
        Framing framing(towardEye, Vec3::UnitZ(), kAspect);
        framing.include(point);
        framing.include(Vec3(point + length * towardEye));
        const Camera camera = framing.camera();
        EXPECT_GT((camera.eye - point).dot(towardEye), length * towardEye.squaredNorm());
        EXPECT_GT((camera.eye - camera.target).dot(towardEye), 0.0);
        EXPECT_LT(Reach(camera, {point}).most(), 1e-6);
    }
}

/// How far the eye is from a row of things, one metre apart, and one more at `last`.
double distanceTo(int count, const Vec3& last)
{
    Framing view(threeQuarterView(false), Vec3::UnitY(), kAspect);
    std::vector<Framing> each;
    for (int i = 0; i < count; ++i) {
        each.push_back(view);
        each.back().include(i + 1 < count ? Vec3(i, 0, 0) : last);
    }
    view.includeMost(each);
    return (view.camera().eye - view.camera().target).norm();
}

// Four hundred shards of a pane were two dozen pixels wide: the ball that had been thrown through
// it rolled on for as long as the shot went on.
TEST(Framing, OneOfManyThatGoesFarAwayIsLeftOut)
{
    const double row = distanceTo(100, {99, 0, 0});
    EXPECT_LT(distanceTo(100, {0, 0, -1000}), 1.01 * row);
    EXPECT_GT(distanceTo(100, {180, 0, 0}), 1.7 * row);                          // not so far
    EXPECT_GT(distanceTo(10, {0, 0, -1000}), 10.0 * distanceTo(10, {9, 0, 0}));  // of few
}

TEST(Framing, OfNothingIsStillACamera)
{
    const Camera camera = Framing(threeQuarterView(false), Vec3::UnitY(), kAspect).camera();
    EXPECT_TRUE(camera.eye.allFinite());
    EXPECT_GT((camera.eye - camera.target).norm(), 0.0);
}

}  // namespace
}  // namespace scree
