#include "render/hidden_bodies.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/preview_scene.h"

namespace scree {
namespace {

constexpr int kSize = 200;

/// Bodies of one mesh, and the camera that sees them.
struct Heap {
    ShadedMesh mesh;
    std::vector<PlacedMesh> bodies;
    std::vector<Ball> balls;
    Mat4 clipFromWorld = Mat4::Identity();

    explicit Heap(const TriMesh& shape) : mesh(shadeMesh({"mesh", shape.points, shape.triangles}))
    {
    }
    void add(const Pose& pose)
    {
        bodies.push_back({&mesh, pose});
        balls.push_back({pose * mesh.centre, mesh.radius});
    }
    void seeFrom(const Camera& camera)
    {
        const DepthRange range = fitDepth(camera, 1.0, balls, {}, 10.0);
        clipFromWorld = clipFromView(camera, 1.0, range) * viewFromWorld(camera);
    }
    DepthMap draw(std::vector<std::size_t>& seen) const
    {
        DepthMap map;
        clearDepths(map, kSize);
        seen = drawNearToFar(map, bodies, balls, clipFromWorld, 0.0);
        return map;
    }
};

/// Boxes of edge 1 along the line of sight, seen from z = 10.
Heap boxesAt(const std::vector<Vec3>& places)
{
    Heap heap(makeBox(Vec3::Ones(), {1, 1, 1}));
    for (const Vec3& place : places) heap.add({place, Quat::Identity()});
    Camera camera;
    camera.eye = {0, 0, 10};
    heap.seeFrom(camera);
    return heap;
}

TEST(HiddenBodies, ABodyWhollyBehindAnotherIsLeftOutAndOneThatSticksOutIsNot)
{
    // Seen from 10 away a box 3 behind another of its size is smaller all round.
    std::vector<std::size_t> seen;
    boxesAt({{0, 0, -3}, {0, 0, 0}}).draw(seen);
    EXPECT_EQ(seen, std::vector<std::size_t>{1});
    boxesAt({{0.5, 0, -3}, {0, 0, 0}}).draw(seen);
    EXPECT_EQ(seen, (std::vector<std::size_t>{1, 0}));
}

TEST(HiddenBodies, WhatTheCameraDoesNotLookAtIsLeftOut)
{
    std::vector<std::size_t> seen;
    boxesAt({{0, 0, 0}, {9, 0, 0}, {0, -9, 0}, {2, 0, 0}}).draw(seen);
    EXPECT_EQ(seen, (std::vector<std::size_t>{0, 3}));
}

TEST(HiddenBodies, ABodyAroundTheCameraIsKept)
{
    std::vector<std::size_t> seen;
    boxesAt({{0, 0, 0}, {0, 0, 9.9}}).draw(seen);
    EXPECT_EQ(seen, (std::vector<std::size_t>{1, 0}));
}

TEST(HiddenBodies, LeavingThemOutChangesNoTexelOfAHeap)
{
    // Against the least depth of all bodies drawn each alone, from a camera and from a light.
    const test::PreviewScene scene = test::heapOfRings(600);
    Heap heap(makeTorus(1.0, 0.25, {16, 10}));
    for (std::size_t i = 0; i < scene.scene.bodies.size(); ++i)
        if (scene.scene.bodies[i].moves) heap.add(scene.frame.worldFromAsset[i]);
    heap.seeFrom(scene.camera);
    const DepthMapFit fit =
        fitDepthMap({-0.3, 0.8, 0.5}, heap.balls, Points(3, 0), 0.0, 0.0, kSize);
    for (const Mat4& clip : {heap.clipFromWorld, fit.clipFromWorld}) {
        heap.clipFromWorld = clip;
        std::vector<std::size_t> seen;
        const DepthMap map = heap.draw(seen);
        EXPECT_LT(seen.size(), heap.bodies.size());
        DepthMap expected;
        clearDepths(expected, kSize);
        for (std::size_t i = 0; i < heap.bodies.size(); ++i) {
            Heap alone = heap;
            alone.bodies = {heap.bodies[i]};
            alone.balls = {heap.balls[i]};
            const DepthMap one = alone.draw(seen);
            std::ranges::transform(one.depths, expected.depths, expected.depths.begin(),
                                   [](float a, float b) { return std::min(a, b); });
        }
        EXPECT_EQ(map.depths, expected.depths);
    }
}

TEST(HiddenBodies, TheMapOfAPictureHasAPixelForATexel)
{
    // The corners of the picture are the corners of its part of the map, whatever its shape.
    for (const auto& [width, height] : {std::pair(64, 36), std::pair(30, 65)}) {
        const PictureMap map = mapOfPicture(Mat4::Identity(), width, height);
        ASSERT_EQ(map.size, std::max(width, height));
        const auto texelOf = [&](double x, double y) {
            const Eigen::Vector4d clip = map.clipFromWorld * Eigen::Vector4d(x, y, 0.0, 1.0);
            return Eigen::Vector2d(0.5 * map.size * (clip.head<2>().array() + 1.0));
        };
        EXPECT_TRUE(texelOf(-1, -1).isZero(1e-9));
        EXPECT_TRUE(texelOf(1, 1).isApprox(Eigen::Vector2d(width, height)));
    }
}

}  // namespace
}  // namespace scree
