// Islands that are solved block by block: nobody is left out or solved twice, and bits do not
// depend on who else is there.
#include "core/dynamics/gaps/gap_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "core/dynamics/gaps/gap_kept.h"
#include "core/dynamics/gaps/gap_pairs.h"
#include "core/dynamics/gaps/gap_search.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kStep = 1.0 / 96.0;
constexpr int kStacks = 3, kCubesOfAStack = 6;

/// Crooked stacks onto which a cube falls, and beside them so many single cubes.
World stacksAndCubes(int cubes)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.2);
    addPlane(world, material);
    const auto cube = boxShape(Vec3::Ones(), 1);
    for (int stack = 0; stack < kStacks; ++stack) {
        for (int i = 0; i < kCubesOfAStack; ++i) {
            const double height = i + 0.5 + (i + 1 == kCubesOfAStack ? 0.05 : 0.0);
            addBody(world, cube, material,
                    {Vec3(4.0 * stack, height, 0.1 * (i % 2)), Quat::Identity()});
        }
    }
    for (int i = 0; i < cubes; ++i) {
        addBody(world, cube, material,
                {Vec3(2.0 * (i % 60), 0.5, 10.0 + 2.0 * (i / 60)), Quat::Identity()});
    }
    return world;
}

TEST(GapBlocks, EveryPairAndEveryBodyIsInOne)
{
    World world = stacksAndCubes(3000);
    const StepSettings settings = screeSettings();
    GapScratch scratch;
    findGaps(world, settings, kStep, scratch);
    layPairs(world, scratch);
    SolvedIslands().handOn(scratch);
    orderPairs(world, scratch);
    scratch.islands[1].isKept = true;
    scratch.openIslands.erase(scratch.openIslands.begin() + 1);
    layBlocks(scratch);
    ASSERT_GT(scratch.blocks.size(), 3u);
    std::vector<std::size_t> islands;
    std::multiset<std::size_t> pairs;
    std::multiset<BodyId> bodies;
    for (const GapBlock& block : scratch.blocks) {
        for (std::size_t n = 0; n < block.pairs.size(); ++n)
            EXPECT_EQ(scratch.pairs[block.pairs[n]].place, n);
        for (std::size_t n = 0; n < block.bodies.size(); ++n)
            EXPECT_EQ(scratch.placeInBlock[block.bodies[n]], static_cast<std::int32_t>(n) + 1);
        islands.insert(islands.end(), block.islands.begin(), block.islands.end());
        pairs.insert(block.pairs.begin(), block.pairs.end());
        bodies.insert(block.bodies.begin(), block.bodies.end());
    }
    std::vector<std::size_t> open(scratch.islands.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    open.erase(open.begin() + 1);
    EXPECT_EQ(islands, open);
    std::set<BodyId> bodiesOfOpen;
    for (std::size_t i = 0; i < scratch.pairs.size(); ++i) {
        const bool isKept = scratch.pairs[i].island == 1;
        EXPECT_EQ(pairs.count(i), isKept ? 0u : 1u) << i;
        if (!isKept) bodiesOfOpen.insert({scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b});
    }
    bodiesOfOpen.erase(0);
    EXPECT_TRUE(std::ranges::equal(bodies, bodiesOfOpen));
    EXPECT_EQ(scratch.placeInBlock[0], 0) << "the ground is in none";
}

TEST(GapBlocks, StacksFallAmongThousandsAsTheyDoAlone)
{
    World alone = stacksAndCubes(0), among = stacksAndCubes(3000);
    Stepper stepperOfAlone(screeSettings()), stepperOfAmong(screeSettings());
    for (int step = 0; step < 40; ++step) {
        stepperOfAlone.step(alone, kStep);
        stepperOfAmong.step(among, kStep);
    }
    for (std::size_t b = 0; b < alone.bodyCount(); ++b) {
        EXPECT_EQ(alone.motion[b].position, among.motion[b].position) << b;
        EXPECT_EQ(alone.motion[b].velocity, among.motion[b].velocity) << b;
        EXPECT_EQ(alone.motion[b].angularMomentum, among.motion[b].angularMomentum) << b;
    }
    EXPECT_NE(alone.motion[kCubesOfAStack].position.x(), 0.0) << "blows have come to the cubes";
}

}  // namespace
}  // namespace scree::test
