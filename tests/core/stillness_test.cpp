// Which heaps are about to come to rest, and get more sweeps for it.
#include "core/dynamics/gaps/stillness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Ten cubes, `moving` of which have just moved; the others have stayed for these frames.
bool settles(int moving, int nearby, int around)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    world.frameDuration = 1.0 / 24.0;
    GapScratch scratch;
    scratch.bodies.resize(10);
    GapIsland island;
    for (int i = 0; i < 10; ++i) {
        island.movers.push_back(addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material, {}));
        scratch.bodies[i].pull = {0.0, -9.8, 0.0};
        scratch.bodies[i].inverseMass = 1.0;
        BodyRest rest;
        if (i >= moving) {
            rest.nearby.frames = nearby;
            rest.around.frames = around;
        }
        world.contactMemory.rest.push_back(rest);
    }
    return isSettling(world, scratch, island);
}

// A chimney with a hole in its foot crept by a few thousandths of a brick in a frame: never nearby
// for long, and never at rest.
TEST(Stillness, AHeapSettlesWhenNineInTenHaveStayedNearbyForAWhileOrAroundForLong)
{
    EXPECT_TRUE(settles(1, 36, 0));
    EXPECT_FALSE(settles(2, 36, 0));
    EXPECT_FALSE(settles(0, 35, 0));
    const double unit = std::sqrt(0.5 * std::sqrt(3.0) / 9.8);  // [s]
    const int longAround = static_cast<int>(std::ceil(kLongAround * unit * 24.0));
    EXPECT_TRUE(settles(1, 0, longAround));
    EXPECT_FALSE(settles(2, 0, longAround));
    EXPECT_FALSE(settles(0, 0, longAround - 1));
}

/// Whether a cube that creeps is still after half a second; `speed` as a share of √(size · g).
bool isStill(double edge, double speed)
{
    World world;
    world.frameDuration = 1.0 / 24.0;
    const auto cube = boxShape({edge, edge, edge}, 1);
    addBody(world, cube, addMaterial(world, 0.5, 0.0), {});
    world.contactMemory.rest.resize(1);
    for (int f = 0; f <= kStillFrames; ++f) {
        world.motion[0].position.x() =
            f * world.frameDuration * speed * std::sqrt(cube->boundingRadius * 9.8);
        noteStays(world, {{Vec3(0.0, -9.8, 0.0)}});
    }
    return world.contactMemory.rest[0].still.frames >= kStillFrames;
}

// At the origin it was still a frame sooner than elsewhere; and what a script let go of was calmed
// at once for having been about before.
TEST(Stillness, CountsFromWhenABodyIsFirstSeenAndAnewAfterAScript)
{
    World world;
    world.frameDuration = 1.0 / 24.0;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const auto cube = boxShape(Vec3::Ones(), 1);
    const BodyId here = addBody(world, cube, material, {});
    const BodyId there = addBody(world, cube, material, {Vec3(9.0, 0.0, 0.0)});
    const std::vector<AppliedForce> forces(2, {Vec3(0.0, -9.8, 0.0)});
    world.contactMemory.rest.resize(2);
    const std::vector<BodyRest>& rest = world.contactMemory.rest;
    for (int f = 0; f < 5; ++f) noteStays(world, forces);
    for (const BodyId body : {here, there}) {
        EXPECT_EQ(rest[body].still.frames, 4);
        EXPECT_EQ(rest[body].nearby.frames, 4);
        EXPECT_EQ(rest[body].around.frames, 4);
    }
    const BodyMass free = std::exchange(world.mass[there], {});
    noteStays(world, forces);
    world.mass[there] = free;
    noteStays(world, forces);
    EXPECT_EQ(rest[there].around.frames, 0);
    EXPECT_EQ(rest[here].around.frames, 6);
}

// A cone of 8 cm whose centre of mass lay a third of a micrometre beside its axis rolled on at
// 13 µm/s, and never slept.
TEST(Stillness, SmallThingsMayCreepAsFastForTheirSizeAsLargeOnes)
{
    for (const double edge : {0.03, 0.1, 1.4}) {
        EXPECT_TRUE(isStill(edge, 6e-5)) << edge;
        EXPECT_FALSE(isStill(edge, 9e-5)) << edge;
    }
    EXPECT_TRUE(isStill(14.0, 1.5e-4));  // and half a second is short for what is larger
}

/// How long a body of this shape that circles on its rim is seen to have stayed around, after 48
/// frames in which it has turned almost twice around its own axis [frames].
int framesAround(const std::shared_ptr<const Shape>& shape, double tilt)
{
    World world;
    world.frameDuration = 1.0 / 24.0;
    addBody(world, shape, addMaterial(world, 0.5, 0.0), {});
    world.contactMemory.rest.resize(1);
    for (int f = 0; f <= 48; ++f) {
        const Quat leaning = fromEulerXyz({0.0, 2.3 * f, 0.0}) * fromEulerXyz({tilt, 0.0, 0.0});
        const Quat worldFromAsset = leaning * fromEulerXyz({0.0, -2.06 * f, 0.0});
        world.motion[0].orientation = worldFromAsset * shape->bodyFromAsset.orientation.conjugate();
        noteStays(world, {{Vec3(0.0, -9.8, 0.0)}});
    }
    return world.contactMemory.rest[0].around.frames;
}

// A screw that circled on its head turned about its own axis as well, never stayed anywhere for
// more than five frames, and kept a heap of four hundred awake for eight seconds.
TEST(Stillness, WhatCirclesOnItsRimStaysAroundThoughItTurns)
{
    const auto can = buildMeshShape("can", makeCylinder(0.03, 0.12, 24, 1));
    EXPECT_EQ(framesAround(can, 0.06), 48);
    EXPECT_LT(framesAround(can, 0.5), 5);
    EXPECT_LT(framesAround(boxShape({0.06, 0.12, 0.06}, 1), 0.06), 5);
}

}  // namespace
}  // namespace scree::test
