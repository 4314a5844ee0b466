// Bodies that come later: nobody meets them before, and they come where there is room.
#include "core/dynamics/births.h"

#include <gtest/gtest.h>

#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree {
namespace {

constexpr double kFrame = 1.0 / 24.0;

/// A plane, and cubes of 1 m that fall from the same place, one due at every frame.
class Births : public testing::Test {
protected:
    Births() : wood_(test::addMaterial(world, 0.5, 0.0)) { test::addPlane(world, wood_); }

    BodyId addCube(const Vec3& position, std::int64_t frame, BirthClearance clearance)
    {
        BodyDefinition cube;
        cube.name = "cube_" + std::to_string(world.bodyCount());
        if (!shape_) shape_ = world.addShape(test::boxShape(Vec3::Ones(), 2));
        cube.shape = *shape_;
        cube.material = wood_;
        cube.worldFromAsset.position = position;
        cube.velocity = Vec3(0.0, -6.0, 0.0);
        cube.birth = {frame, clearance};
        return world.addBody(cube);
    }

    World world;

private:
    MaterialId wood_;
    std::optional<ShapeId> shape_;
};

TEST_F(Births, AnUnbornBodyNeitherMovesNorIsMet)
{
    // It waits inside the place where the other one comes to rest.
    const BodyId falling = addCube(Vec3(0.0, 0.6, 0.0), 0, BirthClearance::wait);
    const BodyId unborn = addCube(Vec3(0.0, 0.5, 0.0), 1000, BirthClearance::wait);
    giveBirths(world);
    const Vec3 place = world.motion[unborn].position;
    Stepper stepper(test::experimentSettings());
    for (int i = 0; i < 12; ++i) stepper.advanceFrame(world, kFrame);
    EXPECT_EQ(world.motion[unborn].position, place);
    // It has fallen 0.1 m onto the plane, where contact holds it within its hover.
    EXPECT_NEAR(world.motion[falling].position.y(), 0.5, 2e-3);
}

TEST_F(Births, ABodyWaitsUntilItsPlaceIsFreeAndMakesNoOverlap)
{
    const BodyId first = addCube(Vec3(0.0, 5.0, 0.0), 0, BirthClearance::wait);
    const BodyId second = addCube(Vec3(0.0, 5.0, 0.0), 1, BirthClearance::wait);
    const Vec3 place = world.motion[second].position;
    giveBirths(world);
    EXPECT_TRUE(world.isBorn(first));
    Stepper stepper(test::experimentSettings());
    int waited = 0;
    while (!world.isBorn(second)) {
        const FrameReport report = stepper.advanceFrame(world, kFrame);
        waited += report.births.waiting;
        ASSERT_LT(world.clock.frame, 24);
        EXPECT_EQ(report.sum.deepestAfterPushOut, 0.0);
    }
    // At 6 m/s and more a cube of 1 m has left its place after 4 frames: 6·t + 4.9·t² = 1.11 m.
    EXPECT_EQ(world.bornAt[second], 4);
    EXPECT_EQ(waited, 3);
    EXPECT_EQ(world.motion[second].position, place);
    EXPECT_EQ(world.motion[second].velocity, Vec3(0.0, -6.0, 0.0));
}

TEST_F(Births, SkippedBodiesNeverComeAndFailingOnesAreNamed)
{
    const BodyId first = addCube(Vec3(0.0, 5.0, 0.0), 0, BirthClearance::wait);
    const BodyId skipped = addCube(Vec3(0.2, 5.0, 0.0), 0, BirthClearance::skip);
    const BodyId failing = addCube(Vec3(0.0, 5.2, 0.0), 0, BirthClearance::fail);
    const BirthReport report = giveBirths(world);
    EXPECT_EQ(report.born, 1);
    EXPECT_EQ(report.skipped, 1);
    EXPECT_EQ(report.failed, failing);
    EXPECT_EQ(report.occupant, first);
    EXPECT_EQ(world.bornAt[skipped], kSkipped);
    world.motion[first].position.x() = 100.0;
    EXPECT_EQ(giveBirths(world).born, 1) << "the failing one, whose place is free now";
    EXPECT_FALSE(world.isBorn(skipped));
}

TEST_F(Births, WhatPassesThroughItIsNotInItsWay)  // [A57]
{
    const BodyId first = addCube(Vec3(0.0, 5.0, 0.0), 0, BirthClearance::wait);
    const BodyId second = addCube(Vec3(0.2, 5.0, 0.0), 0, BirthClearance::wait);
    world.traits[first].groups.collidesWith = 0;
    EXPECT_EQ(giveBirths(world).born, 2);
    EXPECT_TRUE(world.isBorn(second));
}

TEST_F(Births, WhoIsBornBelongsToTheState)
{
    const BodyId late = addCube(Vec3(0.0, 5.0, 0.0), 0, BirthClearance::wait);
    const std::uint64_t before = stateHash(world);
    World other = world;
    giveBirths(world);
    EXPECT_NE(stateHash(world), before);
    other.restoreBirths(world.bornAt);
    EXPECT_EQ(stateHash(other), stateHash(world));
    EXPECT_EQ(other.mass[late].inverseMass, world.massWhenBorn(late).inverseMass);
    EXPECT_GT(other.mass[late].inverseMass, 0.0);
}

}  // namespace
}  // namespace scree
