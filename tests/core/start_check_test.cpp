// What is said of a world before its first step.
#include "core/dynamics/start_check.h"
#include "core/dynamics/gaps/start_separation.h"
#include "core/dynamics/start_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/gaps/sleep.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree {
namespace {

class StartCheck : public testing::Test {
protected:
    StartCheck()
    {
        cube_ = world.addShape(buildMeshShape("cube", makeBox(Vec3::Ones(), {2, 2, 2})));
        plane_ = world.addShape(buildPlaneShape("plane"));
        Material wood;
        wood.name = "wood";
        material_ = world.addMaterial(wood);
    }

    BodyId add(const std::string& name, const Vec3& place, BodyKind kind = BodyKind::dynamic)
    {
        BodyDefinition body;
        body.name = name;
        body.shape = cube_;
        body.material = material_;
        body.kind = kind;
        body.worldFromAsset.position = place;
        return world.addBody(body);
    }

    BodyId addGround()
    {
        BodyDefinition ground;
        ground.name = "ground";
        ground.shape = plane_;
        ground.material = material_;
        ground.kind = BodyKind::fixed;
        return world.addBody(ground);
    }

    World world;
    StepSettings settings;

private:
    ShapeId cube_ = 0, plane_ = 0;
    MaterialId material_ = 0;
};

// Every corner of either lies on the surface of the other: by those alone nothing overlaps.
TEST_F(StartCheck, ABodyInThePlaceOfItsCopyOrFlushWithItOverlaps)
{
    const BodyId one = add("one", {0, 1, 0});
    const BodyId copy = add("copy", {0, 1, 0});
    std::vector<StartOverlap> overlaps = findStartOverlaps(world, 0.01);
    ASSERT_EQ(overlaps.size(), 1u);
    EXPECT_EQ(overlaps[0].a, one);
    EXPECT_EQ(overlaps[0].b, copy);
    EXPECT_NEAR(overlaps[0].depth, 0.5, 1e-9);
    // Moved along one edge: what they share still has their width.
    world.motion[copy].position.x() = 0.3;
    overlaps = findStartOverlaps(world, 0.01);
    ASSERT_EQ(overlaps.size(), 1u);
    EXPECT_GE(overlaps[0].depth, 0.3);
    world.motion[copy].position.x() = 1.0;
    EXPECT_TRUE(findStartOverlaps(world, 1e-9).empty());
}

TEST_F(StartCheck, OverlapsAreListedByDepthAndTouchingIsNone)
{
    const BodyId ground = addGround();
    const BodyId low = add("low", {0, 0.45, 0});        // 0.05 into the ground
    const BodyId high = add("high", {0.2, 1.25, 0.1});  // 0.2 into low
    add("resting", {5, 0.5, 0});
    add("beside", {6, 0.5, 0});  // touches with a face
    const std::vector<StartOverlap> overlaps = findStartOverlaps(world, 0.01);
    ASSERT_EQ(overlaps.size(), 2u);
    EXPECT_EQ(overlaps[0].a, low);
    EXPECT_EQ(overlaps[0].b, high);
    EXPECT_NEAR(overlaps[0].depth, 0.2, 1e-7);  // deep inside the field is single precision
    EXPECT_EQ(overlaps[1].a, ground);
    EXPECT_NEAR(overlaps[1].ratio, 0.05, 1e-9);
    EXPECT_EQ(findStartOverlaps(world, 0.1).size(), 1u);
    // Bodies whose groups do not meet may stand within each other.
    world.traits[high].groups.collidesWith = 0;
    EXPECT_EQ(findStartOverlaps(world, 0.1).size(), 0u);
}

// What is thin is never deep in anything, and stays where no way leads out.
TEST_F(StartCheck, WhatGoesThroughAWallIsToldHoweverThinThatIs)
{
    const double thick = 0.004;
    const auto plate = test::exactBox({0.6, thick, 0.4}, 4);
    const auto stand = [&](const Vec3& place, double degrees) {
        const Quat turned(Eigen::AngleAxisd(degrees * kPi / 180.0, Vec3::UnitX()));
        return test::addBody(world, plate, 0, {place, turned});
    };
    stand({0, 0, 0}, 0.0);
    stand({0, 0.9 * thick, 0}, 0.0);  // lies on the first, a tenth of it too low
    EXPECT_TRUE(findStartOverlaps(world, 0.01).empty());
    const BodyId crossed = stand({0, 0.1, 0.1}, 90.0);
    const std::vector<StartOverlap> overlaps = findStartOverlaps(world, 0.01);
    ASSERT_EQ(overlaps.size(), 2u);
    for (const StartOverlap& overlap : overlaps) {
        EXPECT_EQ(overlap.b, crossed);
        EXPECT_TRUE(overlap.isThroughWall);
        EXPECT_LE(overlap.ratio, 0.01);
    }
}

class SeparationAtStart : public StartCheck, public testing::WithParamInterface<Method> {
protected:
    SeparationAtStart() { settings.method = GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(BothMethods, SeparationAtStart,
                         testing::Values(Method::paper, Method::scree), [](const auto& method) {
                             return method.param == Method::paper ? "Paper" : "Scree";
                         });

TEST_P(SeparationAtStart, PushesApartAndGivesNoSpeed)
{
    addGround();
    const BodyId low = add("low", {0, 0.45, 0});
    const BodyId high = add("high", {0.05, 1.3, 0.1});
    const BodyId alone = add("alone", {7, 0.5, 0});
    const Vec3 aloneBefore = world.motion[alone].position;
    world.motion[high].velocity = Vec3(1, 2, 3);
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    EXPECT_TRUE(findStartOverlaps(world, 0.005).empty());
    EXPECT_EQ(world.motion[high].velocity, Vec3(1, 2, 3));
    EXPECT_TRUE(world.motion[low].velocity.isZero(0.0));
    EXPECT_TRUE(world.motion[low].angularMomentum.isZero(0.0));
    EXPECT_EQ(world.motion[alone].position, aloneBefore);
    // Nothing is thrown far: both moved by less than twice what they overlapped.
    EXPECT_LT((world.motion[high].position - Vec3(0.05, 1.3, 0.1)).norm(), 0.4);
}

TEST_P(SeparationAtStart, WhatItTurnsSpinsAsBefore)
{
    const MaterialId material = test::addMaterial(world, 0.5, 0.0);
    test::addPlane(world, material);
    const Vec3 spin(1.0, -2.0, 3.0);
    const BodyId plank = test::addBody(world, test::boxShape({2.0, 0.2, 0.6}, 2), material,
                                       {{0.0, 0.2, 0.0}, exponentialMap({0.0, 0.0, 0.3})}, 1.0,
                                       {0.5, 0.0, 0.0}, spin);
    const Quat before = world.motion[plank].orientation;
    separateAtStart(world, settings, 0.01);
    ASSERT_GT(world.motion[plank].orientation.angularDistance(before), 0.01);
    EXPECT_LT((test::angularVelocityOf(world, plank) - spin).norm(), 1e-12);
}

TEST_P(SeparationAtStart, MovesWhoSleepsAndLetsHimSleepOn)
{
    addGround();
    const BodyId low = add("low", {0, 0.5, 0});
    const BodyId high = add("high", {0.05, 1.3, 0.1});
    sleepFromTheStart(world, settings, {low, high});
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    EXPECT_TRUE(findStartOverlaps(world, 0.005).empty());
    EXPECT_TRUE(world.contactMemory.isAsleep(low) && world.contactMemory.isAsleep(high));
    EXPECT_EQ(world.contactMemory.rest[high].still.position, world.motion[high].position);
}

TEST_P(SeparationAtStart, ACopyComesOutOfItsOriginal)
{
    addGround();
    add("original", {0, 0.5, 0});
    add("copy", {0, 0.5, 0});
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    EXPECT_TRUE(findStartOverlaps(world, 0.005).empty());
}

// Contacts hold what crosses: all that they know leads along the rods.
TEST_P(SeparationAtStart, RodsThatCrossComeApartByAboutTheirThickness)
{
    const double thick = 0.04;
    const auto rod = test::boxShape({1.0, thick, thick}, 12);
    const auto place = [&](const Vec3& at, const Vec3& along) {
        const Quat turned = Quat::FromTwoVectors(Vec3::UnitX(), along);
        return test::addBody(world, rod, 0, {at, turned});
    };
    const BodyId one = place({0, 1, 0}, {1, 0, 0.1});
    const BodyId other = place({0.1, 1.01, 0.05}, {0.3, 0.1, 1});
    const BodyId third = place({-0.2, 1.005, 0.0}, {0.5, -0.1, 1});
    ASSERT_EQ(findStartOverlaps(world, 0.01).size(), 2u);
    const std::vector<BodyMotion> before = world.motion;
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    EXPECT_TRUE(findStartOverlaps(world, 0.005).empty());
    for (const BodyId body : {one, other, third}) {
        EXPECT_LT((world.motion[body].position - before[body].position).norm(), 1.5 * thick);
    }
}

// Out of one board it comes into the other.
TEST_P(SeparationAtStart, WhatIsHemmedInComesOutOfAll)
{
    BodyDefinition board;
    board.name = "board";
    board.shape = world.addShape(test::boxShape({0.3, 0.02, 0.3}, 12));
    board.kind = BodyKind::fixed;
    for (const double y : {0.01, 0.07}) {
        board.worldFromAsset.position.y() = y;
        world.addBody(board);
    }
    const auto cube = test::boxShape({0.05, 0.05, 0.05}, 12);
    const BodyId between = test::addBody(world, cube, 0, {Vec3(0, 0.03, 0), Quat::Identity()});
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    EXPECT_TRUE(findStartOverlaps(world, 0.005).empty());
    EXPECT_GT(std::abs(world.motion[between].position.y() - 0.04), 0.06);
}

TEST_P(SeparationAtStart, WhatIsPackedTooCloselyStaysInOrder)
{
    constexpr int kCubes = 5;  // along each edge of the block
    const double edge = 0.1, apart = 0.9 * edge;
    addGround();
    const auto cube = test::boxShape({edge, edge, edge}, 12);
    std::array<std::array<std::array<BodyId, kCubes>, kCubes>, kCubes> block;
    for (int x = 0; x < kCubes; ++x) {
        for (int y = 0; y < kCubes; ++y) {
            for (int z = 0; z < kCubes; ++z) {
                const Vec3 place(apart * x, 0.5 * edge + apart * y, apart * z);
                block[x][y][z] = test::addBody(world, cube, 0, {place, Quat::Identity()});
            }
        }
    }
    ASSERT_TRUE(separateAtStart(world, settings, 0.01));
    const auto placeOf = [&](BodyId body) { return world.motion[body].position; };
    for (int i = 1; i < kCubes; ++i) {
        for (int j = 0; j < kCubes; ++j) {
            for (int k = 0; k < kCubes; ++k) {
                EXPECT_GT(placeOf(block[i][j][k]).x(), placeOf(block[i - 1][j][k]).x());
                EXPECT_GT(placeOf(block[j][i][k]).y(), placeOf(block[j][i - 1][k]).y());
                EXPECT_GT(placeOf(block[j][k][i]).z(), placeOf(block[j][k][i - 1]).z());
            }
        }
    }
}

TEST_P(SeparationAtStart, TellsHowManyAreLeftAndMayBeEnded)
{
    addGround();
    add("low", {0, 0.45, 0});
    add("high", {0.05, 1.3, 0.1});
    std::vector<std::size_t> left;
    ASSERT_TRUE(separateAtStart(world, settings, 0.01,
                                [&](std::size_t pairsLeft) { left.push_back(pairsLeft); }));
    ASSERT_FALSE(left.empty());
    EXPECT_EQ(left.front(), 2u);

    add("copy", {0.05, 1.3, 0.1});
    struct Ended {};
    const auto end = [](std::size_t) { throw Ended(); };
    EXPECT_THROW(separateAtStart(world, settings, 0.01, end), Ended);
}

TEST_P(SeparationAtStart, WhatCannotComeApartIsTold)
{
    // Between floor and ceiling there is less room than the cube needs.
    addGround();
    const BodyId ceiling = addGround();
    world.motion[ceiling].position.y() = 0.8;
    world.motion[ceiling].orientation = Quat(0, 1, 0, 0);
    add("wedged", {0, 0.4, 0});
    EXPECT_FALSE(separateAtStart(world, settings, 0.01));
}

TEST_F(StartCheck, BodiesBesideAllSupportAreNamed)
{
    add("table", {0, 0, 0}, BodyKind::fixed);
    add("above", {0.3, 5, 0});
    const BodyId beside = add("beside", {3, 5, 0});
    const BodyId below = add("below", {0, -3, 0});
    EXPECT_EQ(findUnsupported(world, settings.gravity), (std::vector<BodyId>{beside, below}));
    EXPECT_TRUE(findUnsupported(world, Vec3::Zero()).empty());
    addGround();
    EXPECT_TRUE(findUnsupported(world, settings.gravity).empty());
    // What passes through the ground, or the table, is not held by it.
    world.traits[beside].groups.collidesWith = 0;
    const BodyId above = beside - 1;
    EXPECT_EQ(findUnsupported(world, settings.gravity), (std::vector<BodyId>{beside}));
    world.traits[above].groups.collidesWith = 0;
    EXPECT_EQ(findUnsupported(world, settings.gravity), (std::vector<BodyId>{above, beside}));
}

TEST_F(StartCheck, AmongManyBodiesTheSameAreNamedAsOneByOne)
{
    std::vector<Vec3> tables, places;
    const auto place = [](std::uint64_t i) -> Vec3 { return 12.0 * test::signedUnits(i, 0); };
    for (std::uint64_t i = 0; i < 40; ++i) {
        tables.push_back(place(i));
        add("table_" + std::to_string(i), tables.back(), BodyKind::fixed);
    }
    std::vector<BodyId> expected;
    for (std::uint64_t i = 40; i < 440; ++i) {
        const Vec3 p = place(i);
        const BodyId body = add("cube_" + std::to_string(i), p);
        const bool isHeld = std::any_of(tables.begin(), tables.end(), [&](const Vec3& table) {
            return std::abs(table.x() - p.x()) <= 1.0 && std::abs(table.z() - p.z()) <= 1.0 &&
                   table.y() <= p.y() + 1.0;
        });
        if (!isHeld) expected.push_back(body);
    }
    EXPECT_EQ(findUnsupported(world, settings.gravity), expected);
    EXPECT_GT(expected.size(), 50u);
    EXPECT_LT(expected.size(), 350u);
}

TEST_F(StartCheck, SpeedsBeyondTheCapAreNamedWithTheStepsTheyNeed)
{
    addGround();
    const BodyId fast = add("fast", {0, 5, 0});
    add("slow", {3, 5, 0});
    const BodyId high = add("high", {6, 200000, 0});
    add("on_top", {6, 200001, 0});  // falls with it, and is held by it
    world.motion[fast].velocity = Vec3(3000, 0, 0);
    const std::vector<FastBody> bodies = findTooFast(world, settings, 1.0 / 24.0);
    ASSERT_EQ(bodies.size(), 2u);
    EXPECT_EQ(bodies[0].body, fast);
    // A16: a quarter of the thickness, 1 m, in a step at the default safety.
    EXPECT_NEAR(bodies[0].stepsNeeded, 3000.0 / 24.0 / 0.25, 1e-6);
    EXPECT_FALSE(bodies[0].whenItLands);
    EXPECT_EQ(bodies[1].body, high);  // lands at √(2 · 9.81 · 200000) = 1981 m/s
    EXPECT_NEAR(bodies[1].stepsNeeded, std::sqrt(2.0 * 9.81 * 200000.0) / 24.0 / 0.25, 1e-3);
    EXPECT_TRUE(bodies[1].whenItLands);
    // Of what is a blur method scree may pass four thicknesses, at safety 1.
    settings.method = Method::scree;
    world.motion[fast].velocity = Vec3(12000, 0, 0);
    EXPECT_TRUE(findTooFast(world, settings, 1.0 / 24.0).empty());
    world.motion[fast].velocity = Vec3(13000, 0, 0);
    const std::vector<FastBody> withScree = findTooFast(world, settings, 1.0 / 24.0);
    ASSERT_EQ(withScree.size(), 1u);
    EXPECT_NEAR(withScree[0].stepsNeeded, 13000.0 / 24.0 / 2.0, 1e-6);
}

}  // namespace
}  // namespace scree
