// Bodies that come later: nobody meets them before, and they come where there is room.
#include "core/dynamics/births.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/collision/interference.h"
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

/// The first that stands in the way, or −1, of those who are there in the order they came.
BodyId firstOccupant(const World& world, const std::vector<BodyId>& there, BodyId newcomer)
{
    const auto boxOf = [&](BodyId body) {
        return boxAt(world.shapeOf(body), world.motion[body].worldFromBody());
    };
    const auto occupant = std::ranges::find_if(there, [&](BodyId body) {
        return boxOf(newcomer).overlaps(boxOf(body)) && standsInTheWay(world, body, newcomer);
    });
    return occupant == there.end() ? -1 : *occupant;
}

/// What giveBirths does, by looking at all.
BirthReport giveBirthsPlainly(World& world)
{
    BirthReport report;
    std::vector<BodyId> there;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.isBorn(body)) there.push_back(body);
    }
    for (const PlannedBirth& birth : world.births) {
        if (birth.frame > world.clock.frame || world.bornAt[birth.body] != kUnborn) continue;
        const BodyId occupant = firstOccupant(world, there, birth.body);
        if (occupant < 0) {
            world.beBorn(birth);
            there.push_back(birth.body);
            ++report.born;
        } else if (birth.clearance == BirthClearance::fail) {
            report.failed = birth.body;
            report.occupant = occupant;
            return report;
        } else {
            ++report.waiting;
        }
    }
    return report;
}

TEST_F(Births, AmongHundredsTheSameComeAsWhereEachLooksAtAll)
{
    const auto draw = [](std::uint64_t i, std::uint64_t what) {
        const Vec3 unit(randomUnit(7, i, what, 0), randomUnit(7, i, what, 1),
                        randomUnit(7, i, what, 2));
        return Vec3(14.0 * unit);
    };
    for (std::uint64_t i = 0; i < 1200; ++i)  // the later ones are there when the others come
        addCube(draw(i, 0), i < 600 ? 1 : 0, BirthClearance::wait);
    for (std::uint64_t i = 0; i < 40; ++i) addCube(draw(i, 1), 2, BirthClearance::fail);
    World other = world;
    for (std::int64_t call = 0; call < 42; ++call) {
        world.clock.frame = other.clock.frame = std::min<std::int64_t>(call, 2);
        const BirthReport report = giveBirths(world), plain = giveBirthsPlainly(other);
        ASSERT_EQ(world.bornAt, other.bornAt) << "call " << call;
        EXPECT_EQ(report.born, plain.born);
        EXPECT_EQ(report.waiting, plain.waiting);
        ASSERT_EQ(report.failed, plain.failed) << "call " << call;
        EXPECT_EQ(report.occupant, plain.occupant);
        if (call == 0) {
            EXPECT_GT(report.born, 250) << "more than are looked at one by one";
        }
        if (report.failed >= 0)  // it makes way for the next that may not wait
            world.bornAt[report.failed] = other.bornAt[report.failed] = kSkipped;
    }
    EXPECT_GT(std::ranges::count(world.bornAt, kSkipped), 20);
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
