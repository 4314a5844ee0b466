// Keyed cameras and orbits.
#include "core/picture/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

/// Four keys: a long rise of x, a rest, a way back.
SceneCamera keyed(bool isSmooth)
{
    SceneCamera camera;
    camera.isSmooth = isSmooth;
    camera.keys = {{1001.0, {0.0, 2.0, 9.0}, {0.0, 0.0, 0.0}, 30.0},
                   {1011.0, {10.0, 2.0, 9.0}, {1.0, 0.0, 0.0}, 30.0},
                   {1021.0, {10.0, 2.0, 9.0}, {1.0, 0.0, 0.0}, 50.0},
                   {1031.0, {4.0, 2.0, 9.0}, {0.0, 0.0, 0.0}, 40.0}};
    return camera;
}

TEST(KeyedCamera, StandsAtItsKeysAndRestsBeforeTheFirstAndAfterTheLast)
{
    for (const bool isSmooth : {true, false}) {
        const SceneCamera camera = keyed(isSmooth);
        for (const CameraKey& key : camera.keys) {
            const SceneCamera now = cameraAt(camera, key.frame, false);
            EXPECT_LT((now.eye - key.eye).norm(), 1e-12);
            EXPECT_LT((now.target - key.target).norm(), 1e-12);
            EXPECT_NEAR(now.fovDegrees, key.fovDegrees, 1e-12);
        }
        EXPECT_EQ(cameraAt(camera, 900.0, false).eye, camera.keys.front().eye);
        EXPECT_EQ(cameraAt(camera, 2000.0, false).eye, camera.keys.back().eye);
    }
}

TEST(KeyedCamera, LinearGoesStraightAndSmoothSetsOffAndArrivesGently)
{
    EXPECT_NEAR(cameraAt(keyed(false), 1003.5, false).eye.x(), 2.5, 1e-12);
    EXPECT_NEAR(cameraAt(keyed(false), 1016.0, false).fovDegrees, 40.0, 1e-12);
    // At rest at the first key, x grows with the square of the time at first: a tenth of a frame
    // moves it by 10 · 3 · 0.01² at most.
    const SceneCamera camera = keyed(true);
    EXPECT_LT(cameraAt(camera, 1001.1, false).eye.x(), 0.0031);
    EXPECT_LT(cameraAt(camera, 1030.9, false).eye.x() - 4.0, 0.0031);
}

TEST(KeyedCamera, ASmoothWayNeverOvershootsAndHasNoKink)
{
    const SceneCamera camera = keyed(true);
    const double h = 1e-4;
    double before = 0.0, slopeBefore = 0.0;
    for (double frame = 1001.0; frame < 1031.0; frame += 0.125) {
        const double x = cameraAt(camera, frame, false).eye.x();
        EXPECT_LE(x, 10.0 + 1e-12) << frame;
        if (frame <= 1011.0) {
            EXPECT_GE(x, before - 1e-12) << frame;
        }
        if (frame > 1011.0 && frame < 1021.0) {
            EXPECT_EQ(x, 10.0) << "two equal keys are a rest";
        }
        // The second derivative of a stretch is 6 Δ/h² = 0.6 at most: in an eighth of a frame the
        // slope changes by less than 0.08. A kink at a key would be 1.
        const double slope = (cameraAt(camera, frame + h, false).eye.x() - x) / h;
        EXPECT_LT(std::abs(slope - slopeBefore), 0.08) << frame;
        before = x;
        slopeBefore = slope;
    }
}

TEST(OrbitingCamera, KeepsDistanceAndHeightAndTurnsAgainstTheClockSeenFromAbove)
{
    SceneCamera camera;
    camera.orbit = CameraOrbit{{1.0, 2.0, 3.0}, 5.0, 2.0, 0.0, 90.0, 1001.0, 1011.0};
    const SceneCamera first = cameraAt(camera, 1001.0, false);
    EXPECT_LT((first.eye - Vec3(1.0, 4.0, 8.0)).norm(), 1e-12);
    EXPECT_LT((cameraAt(camera, 1011.0, false).eye - Vec3(6.0, 4.0, 3.0)).norm(), 1e-12);
    EXPECT_EQ(cameraAt(camera, 1000.0, false).eye, first.eye);
    for (const double frame : {1002.5, 1007.0}) {
        const SceneCamera now = cameraAt(camera, frame, false);
        EXPECT_NEAR((now.eye - now.target).norm(), std::hypot(5.0, 2.0), 1e-12);
        EXPECT_EQ(now.target, Vec3(1.0, 2.0, 3.0));
    }
    // With z up: in front is -y, and up is z.
    EXPECT_LT((cameraAt(camera, 1001.0, true).eye - Vec3(1.0, -3.0, 5.0)).norm(), 1e-12);
    EXPECT_LT((cameraAt(camera, 1011.0, true).eye - Vec3(6.0, 2.0, 5.0)).norm(), 1e-12);
}

TEST(CameraMotion, AnotherUnitScalesTheWholeWay)
{
    SceneCamera orbiting;
    orbiting.orbit = CameraOrbit{{1.0, 2.0, 3.0}, 5.0, 2.0, 30.0, 90.0, 1001.0, 1011.0};
    for (const SceneCamera& camera : {keyed(true), orbiting}) {
        const SceneCamera inCentimetres = scaled(camera, 100.0);
        const Vec3 eye = cameraAt(camera, 1006.3, false).eye;
        EXPECT_LT((cameraAt(inCentimetres, 1006.3, false).eye - 100.0 * eye).norm(), 1e-9);
        EXPECT_TRUE(moves(camera));
    }
    EXPECT_FALSE(moves(SceneCamera()));
}

}  // namespace
}  // namespace scree
