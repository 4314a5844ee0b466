// Levels of graphs given as edges. Who rests on whom: scree verify E6.  [GBF03 “Contact Graph”]
#include <gtest/gtest.h>

#include <vector>

#include "core/dynamics/contact_graph.h"

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

}  // namespace
}  // namespace scree
