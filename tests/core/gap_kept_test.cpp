// A step that is solved again: islands in which nothing has changed stay as they were solved, and
// that is as if they had been solved again.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "core/dynamics/gaps/gap_blocks.h"
#include "core/dynamics/gaps/gap_bounce.h"
#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/gaps/gap_forces.h"
#include "core/dynamics/gaps/gap_foresight.h"
#include "core/dynamics/gaps/gap_kept.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_pairs.h"
#include "core/dynamics/gaps/gap_search.h"
#include "core/dynamics/gaps/gap_shock.h"
#include "core/dynamics/gaps/gap_unseen.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kStep = 1.0 / 96.0;
constexpr int kStacks = 4, kCubes = 5;

BodyId cubeOf(int stack, int cube)
{
    return 1 + kCubes * stack + cube;
}

BodyId ballOf(int stack)
{
    return 1 + kCubes * kStacks + stack;
}

/// Stacks of cubes side by side that have begun to rest; a ball has just hit the first from
/// above, and one hits each of the others in the next step.
World stacksUnderBlows()
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    const auto cube = boxShape(Vec3::Ones(), 1);
    for (int stack = 0; stack < kStacks; ++stack) {
        for (int i = 0; i < kCubes; ++i) {
            addBody(world, cube, material,
                    {Vec3(8.0 * stack, 0.5 + i, 0.02 * (i % 2)), Quat::Identity()});
        }
    }
    for (int stack = 0; stack < kStacks; ++stack) {
        const double speed = 1.0 + stack, apart = stack == 0 ? 0.01 : 1.5 * kStep * speed;
        addBody(world, exactSphere(0.4), material,
                {Vec3(8.0 * stack, kCubes + 0.4 + apart, 0.0), Quat::Identity()}, 1.0,
                Vec3(0.0, -speed, 0.0));
    }
    Stepper stepper(screeSettings());
    stepper.step(world, kStep);
    return world;
}

/// Solves a step without moving anything.
void attempt(World& world, bool isAgain, const SolvedIslands& solved, GapScratch& scratch)
{
    const StepSettings settings = screeSettings();
    isAgain ? findGapsAgain(world, kStep, scratch) : findGaps(world, settings, kStep, scratch);
    layPairs(world, scratch);
    solved.handOn(scratch);
    orderPairs(world, scratch);
    layBlocks(scratch);
    levelOthers(scratch);
    addForcesToOthers(kStep, scratch);
    for (GapBlock& block : scratch.blocks) {
        buildRows(world, settings, kStep, block, scratch);
        const std::vector<Held>& held = heldAsBefore(kStep, block, scratch);
        foreseeBlows(world, settings, kStep, held, block, scratch);
        resolveImpacts(settings, kStep, held, block, scratch);
        findLevels(kStep, block, scratch);
        addForcesToGaps(kStep, block, scratch);
        resolveGaps(world, settings, kStep, block, scratch);
        propagateShockUp(world, kStep, block, scratch);
        scratch.impacts.insert(scratch.impacts.end(), block.impacts.begin(), block.impacts.end());
    }
}

struct Attempts {
    World world = stacksUnderBlows();
    GapScratch scratch;
    std::vector<GapBody> first;

    /// Once, and after `change` once more.
    template <class Change>
    void run(bool keeps, const Change& change)
    {
        attempt(world, false, {}, scratch);
        first = scratch.bodies;
        const SolvedIslands solved(scratch);
        change(world, scratch);
        attempt(world, true, keeps ? solved : SolvedIslands(), scratch);
    }
    std::ptrdiff_t islandsKept() const
    {
        return std::ranges::count_if(scratch.islands, &GapIsland::isKept);
    }
    bool isKept(BodyId body) const { return scratch.bodies[body].isKept; }
};

std::vector<GapRow> rowsOfPairs(const Attempts& attempts)
{
    std::vector<GapRow> rows;
    for (const GapPair& pair : attempts.scratch.pairs) {
        const auto all = attempts.scratch.rows.begin();
        rows.insert(rows.end(), all + static_cast<std::ptrdiff_t>(pair.begin),
                    all + static_cast<std::ptrdiff_t>(pair.end));
    }
    return rows;
}

std::ptrdiff_t bearing(const std::vector<GapRow>& rows)
{
    return std::ranges::count_if(rows, [](const GapRow& row) { return !row.impulse.isZero(0.0); });
}

void expectEqual(const Attempts& kept, const Attempts& whole)
{
    for (std::size_t b = 0; b < kept.scratch.bodies.size(); ++b) {
        const GapBody &p = kept.scratch.bodies[b], &q = whole.scratch.bodies[b];
        EXPECT_EQ(p.velocity, q.velocity) << b;
        EXPECT_EQ(p.spin, q.spin) << b;
        EXPECT_EQ(p.angularImpulse, q.angularImpulse) << b;
        EXPECT_EQ(p.shift, q.shift) << b;
        EXPECT_EQ(p.turn, q.turn) << b;
        EXPECT_EQ(p.velocityBefore, q.velocityBefore) << b;
        EXPECT_EQ(p.isStopped, q.isStopped) << b;
    }
    EXPECT_EQ(kept.scratch.rowCount, whole.scratch.rowCount);
    const std::vector<GapRow> rowsOfKept = rowsOfPairs(kept), rowsOfWhole = rowsOfPairs(whole);
    ASSERT_EQ(rowsOfKept.size(), rowsOfWhole.size());
    for (std::size_t r = 0; r < rowsOfKept.size(); ++r) {
        EXPECT_EQ(rowsOfKept[r].rA, rowsOfWhole[r].rA) << r;
        EXPECT_EQ(rowsOfKept[r].impulse, rowsOfWhole[r].impulse) << r;
        EXPECT_EQ(rowsOfKept[r].target, rowsOfWhole[r].target) << r;
        EXPECT_EQ(rowsOfKept[r].wasHit, rowsOfWhole[r].wasHit) << r;
    }
    // What lies between the rows of pairs bears nothing.
    EXPECT_EQ(bearing(kept.scratch.rows), bearing(rowsOfKept));
    const auto blows = [](const Attempts& attempts) {
        std::vector<std::tuple<BodyId, BodyId, double, double>> found;
        for (const GapImpact& impact : attempts.scratch.impacts) {
            const GapRow& row = attempts.scratch.rows[impact.row];
            found.push_back({row.a, row.b, row.rA.x(), impact.impulse.norm()});
        }
        std::sort(found.begin(), found.end());
        return found;
    };
    EXPECT_EQ(blows(kept), blows(whole));
    EXPECT_GT(blows(kept).size(), 0u);
    EXPECT_EQ(kept.scratch.levels.level, whole.scratch.levels.level);
    EXPECT_EQ(kept.scratch.levels.isSupported, whole.scratch.levels.isSupported);
}

TEST(GapKept, StacksBesideOneThatIsLookedAtFartherStayAsIfSolvedAgain)
{
    const auto gainsSpeed = [](World&, GapScratch& scratch) { scratch.gain[cubeOf(1, 2)] = 3.0; };
    Attempts kept, whole;
    kept.run(true, gainsSpeed);
    whole.run(false, gainsSpeed);
    EXPECT_EQ(kept.scratch.islands.size(), kStacks);
    EXPECT_EQ(kept.islandsKept(), kStacks - 1);
    EXPECT_FALSE(kept.isKept(cubeOf(1, 0)));
    EXPECT_TRUE(kept.isKept(cubeOf(2, 0)));
    expectEqual(kept, whole);
}

TEST(GapKept, AStackOnWhichABallWakesIsSolvedAgain)
{
    Attempts kept, whole;
    for (Attempts* attempts : {&kept, &whole}) {
        World& world = attempts->world;
        world.contactMemory.rest.resize(world.bodyCount());
        BodyRest& rest = world.contactMemory.rest[ballOf(0)];
        rest.isAsleep = true;
        rest.pull = screeSettings().gravity;
        attempts->run(attempts == &kept, [](World& woken, GapScratch&) {
            woken.contactMemory.rest[ballOf(0)].isAsleep = false;
        });
    }
    EXPECT_EQ(kept.islandsKept(), kStacks - 1);
    EXPECT_FALSE(kept.isKept(cubeOf(0, 0)));
    EXPECT_FALSE(kept.isKept(cubeOf(0, 4)));
    EXPECT_NE(kept.first[cubeOf(0, 4)].velocity, kept.scratch.bodies[cubeOf(0, 4)].velocity);
    expectEqual(kept, whole);
}

TEST(GapKept, RowsThatAPairNoLongerHasBearNothing)
{
    const auto losesAContact = [](World&, GapScratch& scratch) {
        const BodyPair lowest{cubeOf(1, 0), cubeOf(1, 1)};
        std::ranges::find(scratch.nearPairs, lowest, &NearPair::bodies)->contacts.pop_back();
    };
    Attempts kept, whole;
    kept.run(true, losesAContact);
    whole.run(false, losesAContact);
    EXPECT_EQ(kept.islandsKept(), kStacks - 1);
    EXPECT_FALSE(kept.isKept(cubeOf(1, 0)));
    EXPECT_GT(kept.scratch.rows.size(), kept.scratch.rowCount);
    expectEqual(kept, whole);
}

TEST(GapKept, AllStaysWhereNothingHasChanged)
{
    Attempts kept;
    kept.run(true, [](World&, GapScratch&) {});
    EXPECT_EQ(kept.islandsKept(), kStacks);
    for (std::size_t b = 0; b < kept.first.size(); ++b)
        EXPECT_EQ(kept.first[b].velocity, kept.scratch.bodies[b].velocity) << b;
}

TEST(GapKept, WhatStaysIsStillLookedAtForWhatItRunsInto)
{
    Attempts kept;
    attempt(kept.world, false, {}, kept.scratch);
    // As if solved so: from the first stack into the highest cube of the second.
    kept.scratch.bodies[ballOf(0)].velocity = Vec3(8.0, -0.9, 0.0) / kStep;
    attempt(kept.world, true, SolvedIslands(kept.scratch), kept.scratch);
    EXPECT_EQ(kept.islandsKept(), kStacks);
    EXPECT_TRUE(lookFartherWhereUnseen(kept.world, kStep, kept.scratch));
    EXPECT_FALSE(lookFartherWhereUnseen(kept.world, kStep, kept.scratch))
        << "it has been looked at";
    EXPECT_GT(kept.scratch.gain[ballOf(0)], 700.0);
}

}  // namespace
}  // namespace scree::test
