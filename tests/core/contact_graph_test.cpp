// Levels of graphs given as edges. Who rests on whom: scree verify E6.  [GBF03 “Contact Graph”]
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "tests/support/scenes.h"

namespace scree {
namespace {

TEST(ContactGraph, AHundredThousandNodesInAChainNeedNoDeepStack)  // [A37]
{
    const int count = 100000;
    std::vector<SupportEdge> edges;
    for (int i = 0; i + 1 < count; ++i) edges.push_back({i, i + 1});
    std::vector<char> isFixed(count, 0);
    isFixed[0] = 1;
    const GraphLevels levels = computeLevels(count, edges, isFixed);
    EXPECT_EQ(levels.level.back(), count - 1);
    EXPECT_TRUE(levels.isSupported.back());
    EXPECT_EQ(levels.componentCount, count);
}

TEST(ContactGraph, ACycleIsOneComponentOneAboveWhatCarriesIt)  // [A37, A38]
{
    // 0 (fixed) → 1 → 2 → 3 → 1, 3 → 4; 5 → 6 → 5 floats.
    const std::vector<SupportEdge> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 1}, {3, 4}, {5, 6}, {6, 5}};
    const std::vector<char> isFixed = {1, 0, 0, 0, 0, 0, 0};
    const GraphLevels levels = computeLevels(7, edges, isFixed);
    EXPECT_EQ(levels.level, (std::vector{0, 1, 1, 1, 2, 0, 0}));
    EXPECT_EQ(levels.componentCount, 4);
    EXPECT_EQ(std::vector<int>(levels.isSupported.begin(), levels.isSupported.end()),
              (std::vector{1, 1, 1, 1, 1, 0, 0}));
}

TEST(ContactGraph, APairIsWorkedOnWithTheHigherOfItsBodies)  // [A38]
{
    World world;
    const MaterialId material = test::addMaterial(world, 0.5, 0.0);
    test::addPlane(world, material);
    for (int i = 0; i < 3; ++i) {
        test::addBody(world, test::boxShape(Vec3::Ones(), 2), material,
                      {{0.0, 0.5 + i, 0.0}, Quat::Identity()});
    }
    const StepSettings settings = test::experimentSettings();
    const double dt = 1.0 / 240.0;
    StepScratch scratch;
    findPairs(world, settings, dt, scratch);
    beginStep(world, settings, dt, scratch);
    resolveCollisions(world, settings, dt, scratch);
    const ContactGraph graph = buildContactGraph(world, settings, dt, scratch);
    ASSERT_EQ(graph.contact.size(), 4u);
    EXPECT_TRUE(graph.contact[0].pairs.empty());
    for (std::size_t level = 1; level < 4; ++level) {
        ASSERT_EQ(graph.contact[level].pairs.size(), 1u) << level;
        const BodyPair bodies = scratch.pairs[graph.contact[level].pairs[0]].bodies;
        EXPECT_EQ(std::max(bodies.a, bodies.b), static_cast<BodyId>(level));
        EXPECT_EQ(graph.contact[level].supportedBodies,
                  std::vector<BodyId>{static_cast<BodyId>(level)});
    }
    EXPECT_EQ(graph.contactPairs, 3);
}

}  // namespace
}  // namespace scree
