// Fast against obvious: the broad phase against all pairs.
#include "core/collision/broad_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/draws.h"

namespace scree::test {
namespace {

std::vector<BodyPair> pairsOfAllAgainstAll(const std::vector<Aabb>& boxes,
                                           const std::vector<BodyMass>& mass)
{
    std::vector<BodyPair> pairs;
    for (BodyId a = 0; a < static_cast<BodyId>(boxes.size()); ++a) {
        for (BodyId b = a + 1; b < static_cast<BodyId>(boxes.size()); ++b) {
            if (!mass[a].isMovable() && !mass[b].isMovable()) continue;
            if (boxes[a].overlaps(boxes[b])) pairs.push_back({a, b});
        }
    }
    return pairs;
}

// It went on with entries of bodies that there no longer were, and read beyond its lists.
TEST(BroadPhase, ForgetsAWorldOfMoreBodies)
{
    std::vector<Aabb> boxes = {{Vec3::Zero(), Vec3::Ones()}};
    while (boxes.size() < 40) boxes.push_back(boxes.front());
    std::vector<BodyMass> mass(boxes.size(), {0.0, Vec3::Zero()});
    for (const std::size_t i : {0, 20, 30}) mass[i] = {1.0, Vec3::Ones()};
    const auto counts = [](BodyPair) { return true; };
    BroadPhase broadPhase;
    for (int step = 0; step < 2; ++step) {
        EXPECT_EQ(broadPhase.findPairs(boxes, mass, counts), pairsOfAllAgainstAll(boxes, mass));
    }
    boxes.resize(3);
    mass.resize(3);
    EXPECT_EQ(broadPhase.findPairs(boxes, mass, counts), pairsOfAllAgainstAll(boxes, mass));
}

TEST(BroadPhase, FindsExactlyThePairsThatAllAgainstAllFindsWhileBodiesMove)  // [A14]
{
    for (std::uint64_t scene = 0; scene < 20; ++scene) {
        std::vector<Aabb> boxes;
        std::vector<BodyMass> mass;
        for (std::uint64_t b = 0; b < 200; ++b) {
            const Vec3 centre = drawVector(scene * 1000 + b, 0, 8.0);
            const double scale = b % 17 == 0 ? 20.0 : 1.0;
            const Vec3 half =
                scale * (drawVector(scene * 1000 + b, 1, 0.4).cwiseAbs() + Vec3::Constant(0.05));
            boxes.push_back({centre - half, centre + half});
            mass.push_back({b % 5 == 0 ? 0.0 : 1.0, Vec3::Ones()});
        }
        boxes.push_back(Aabb::everything());
        mass.push_back({0.0, Vec3::Zero()});
        boxes.push_back({});  // not born yet
        mass.push_back({1.0, Vec3::Ones()});

        BroadPhase broadPhase;
        for (std::uint64_t step = 0; step < 30; ++step) {
            const auto counts = [step](BodyPair pair) {
                return (pair.a + pair.b + static_cast<BodyId>(step)) % 7 != 0;
            };
            std::vector<BodyPair> expected = pairsOfAllAgainstAll(boxes, mass);
            std::erase_if(expected, [&](BodyPair pair) { return !counts(pair); });
            EXPECT_EQ(broadPhase.findPairs(boxes, mass, counts), expected)
                << "scene " << scene << ", step " << step;
            // Many that are asked; and few, when they and some others have grown.
            for (const std::size_t every : {9, 80}) {
                std::vector<char> isAsked(boxes.size(), 0);
                for (std::size_t b = step; b < boxes.size(); b += every) {
                    isAsked[b] = 1;
                    if (every == 9 || b >= 190) continue;
                    for (const std::size_t i : {b, b + 7}) boxes[i] = boxes[i].grown(1.0);
                }
                expected = pairsOfAllAgainstAll(boxes, mass);
                std::erase_if(expected, [&](BodyPair pair) {
                    return !counts(pair) || (!isAsked[pair.a] && !isAsked[pair.b]);
                });
                EXPECT_EQ(broadPhase.findPairs(boxes, mass, counts, isAsked), expected)
                    << "scene " << scene << ", step " << step << ", every " << every;
            }
            for (std::uint64_t b = 0; b < 200; ++b) {
                const Vec3 way = drawVector(scene * 1000 + b, 2, b == 7 ? 1.0 : 0.01);
                boxes[b].min += way;
                boxes[b].max += way;
            }
            if (step == 10) boxes.back() = {-Vec3::Ones(), Vec3::Ones()};
            if (step == 15 || step == 25) {  // most of them: the tree is built anew
                for (std::uint64_t b = 0; b < 200; ++b) {
                    if (b % 3 != 0) boxes[b] = boxes[b].grown(step == 15 ? 3.0 : -3.0);
                }
            }
            if (step == 20) std::swap(mass[0], mass[1]);
        }
    }
}

/// Of millimetres to tens of metres, each about as near to others of its size as those of any.
std::vector<Aabb> boxesOfAllSizes(std::size_t count, const Vec3& middle)
{
    std::vector<Aabb> boxes;
    for (std::uint64_t b = 0; b < count; ++b) {
        const double size = 0.001 * std::ldexp(1.0, static_cast<int>(b % 15));
        const Vec3 centre = middle + drawVector(b, 3, size);
        const Vec3 half = drawVector(b, 4, 0.5 * size).cwiseAbs() + Vec3::Constant(0.1 * size);
        boxes.push_back({centre - half, centre + half});
    }
    return boxes;
}

// Far away everybody shared the outermost cell, and what was as large as many cells was compared
// with all.
TEST(BroadPhase, FindsExactlyThePairsOfBodiesOfAllSizesWhereverTheyAre)
{
    for (const double far : {0.0, 5e3, -4e4, 1e9}) {
        std::vector<Aabb> boxes = boxesOfAllSizes(300, {far, -0.3 * far, 0.1 * far});
        const std::vector<BodyMass> mass(boxes.size(), {1.0, Vec3::Ones()});
        BroadPhase broadPhase;
        for (std::uint64_t step = 0; step < 40; ++step) {
            const std::vector<BodyPair> expected = pairsOfAllAgainstAll(boxes, mass);
            ASSERT_EQ(broadPhase.findPairs(boxes, mass, [](BodyPair) { return true; }), expected)
                << "at " << far << " m, step " << step;
            EXPECT_GT(expected.size(), boxes.size());
            for (std::uint64_t b = 0; b < boxes.size(); ++b) {
                const Vec3 way = drawVector(b, 5 + step % 4, 0.1 * boxes[b].longestEdge());
                boxes[b].min += way;
                boxes[b].max += way;
            }
        }
    }
}

// One after the other, so that nothing else makes anybody be entered anew.
TEST(BroadPhase, KnowsWhoComesGoesAndLosesItsBounds)
{
    std::vector<Aabb> boxes = boxesOfAllSizes(60, Vec3::Zero());
    const std::vector<Aabb> present = boxes;
    const std::vector<BodyMass> mass(boxes.size(), {1.0, Vec3::Ones()});
    BroadPhase broadPhase;
    for (std::size_t step = 0; step < 180; ++step) {
        const std::vector<Aabb> becomes = {{}, Aabb::everything(), present[step % 60]};
        boxes[step % 60] = becomes[step / 60];
        ASSERT_EQ(broadPhase.findPairs(boxes, mass, [](BodyPair) { return true; }),
                  pairsOfAllAgainstAll(boxes, mass))
            << "step " << step;
    }
}

/// How many bodies a tree shows to all who ask for those near them, for each that is near.
double shownForEachNear(const BoxTree& tree, const std::vector<Aabb>& boxes)
{
    double shown = 0.0, near = 0.0;
    for (const Aabb& box : boxes) {
        tree.visit(box, [&](BodyId other) {
            shown += 1.0;
            near += box.overlaps(boxes[other]);
        });
    }
    return shown / near;
}

std::vector<BodyId> allOf(const std::vector<Aabb>& boxes)
{
    std::vector<BodyId> all(boxes.size());
    std::iota(all.begin(), all.end(), BodyId{0});
    return all;
}

// Four thousand beams and twenty thousand chips took 21 s a frame: every beam looked at every chip.
TEST(BoxTree, LooksAtAFewOfTheSmallForEveryLargeOne)
{
    std::vector<Aabb> boxes;
    for (std::uint64_t b = 0; b < 6000; ++b) {
        const bool isBeam = b % 6 == 0;
        const Vec3 half = isBeam ? Vec3(1.5, 0.01, 0.01) : Vec3::Constant(0.01);
        const Vec3 centre = drawVector(b, 6, 2.0);
        boxes.push_back({centre - half, centre + half});
    }
    BoxTree tree;
    tree.build(allOf(boxes), boxes);
    EXPECT_LT(shownForEachNear(tree, boxes), 15.0);
}

TEST(BoxTree, LooksAtNoMoreFarAwayNorAfterAllHaveGoneThere)
{
    std::vector<Aabb> boxes = boxesOfAllSizes(3000, Vec3::Zero());
    BoxTree tree;
    tree.build(allOf(boxes), boxes);
    const double here = shownForEachNear(tree, boxes);
    EXPECT_LT(here, 3.0);
    for (Aabb& box : boxes) box = {box.min + Vec3::Constant(1e7), box.max + Vec3::Constant(1e7)};
    tree.refit(boxes);
    EXPECT_LT(shownForEachNear(tree, boxes), 1.01 * here);
    tree.build(allOf(boxes), boxes);
    EXPECT_LT(shownForEachNear(tree, boxes), 1.01 * here);
}

}  // namespace
}  // namespace scree::test
