// E6: who rests on whom.  [GBF03 “Contact Graph”], [A36–A38]
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

struct SceneGraph {
    ContactGraph graph;
    std::set<std::pair<BodyId, BodyId>> pairs;  // that contact would process
};

SceneGraph graphOf(World world, double dt = 1.0 / 240.0)
{
    const StepSettings settings = experimentSettings();
    StepScratch scratch;
    std::int64_t capped = 0;
    findPairs(world, settings, dt, scratch);
    beginStep(world, settings, dt, scratch);
    resolveCollisions(world, settings, dt, scratch, capped);
    SceneGraph result{buildContactGraph(world, settings, dt, scratch), {}};
    for (const ContactLevel& level : result.graph.contact) {
        for (std::size_t i : level.pairs) {
            result.pairs.insert({scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b});
        }
    }
    return result;
}

/// Dominoes 0.4 × 1 × 0.1 m in a circle on a floor, each leaning 30° along the circle onto the
/// next.
World dominoRing(int count, double radius, bool edgeSamples)
{
    static std::map<bool, std::shared_ptr<const Shape>> built;
    std::shared_ptr<const Shape>& domino = built[edgeSamples];
    if (!domino) {
        ShapeSettings settings;
        settings.edgeSamples = edgeSamples;
        domino = buildMeshShape("domino", makeBox({0.4, 1.0, 0.1}, {8, 20, 2}), settings);
    }
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    const double lean = kPi / 6.0;
    double s = 0.0, c = 0.0;
    sinCos(lean, s, c);
    for (int i = 0; i < count; ++i) {
        const Quat around = exponentialMap({0.0, -2.0 * kPi * i / count, 0.0});
        const Vec3 centre = around * Vec3(radius, 0.5 * c + 0.05 * s, 0.0);
        addBody(world, domino, material, {centre, around * exponentialMap({lean, 0.0, 0.0})});
    }
    return world;
}

/// The largest radius at which neighbours still interfere, by bisection.
double touchingRadius(int count, bool edgeSamples)
{
    double near = 0.2, far = 2.0;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (near + far);
        const World world = dominoRing(count, middle, edgeSamples);
        std::vector<Touch> touches;
        findTouchesPlainly({&world.shapeOf(1), &world.shapeOf(2), world.motion[1].worldFromBody(),
                            world.motion[2].worldFromBody()},
                           1e-9, touches);
        (touches.empty() ? far : near) = middle;
    }
    return near;
}

TEST(E6ContactGraph, LeaningDominoesInACircleAreOneLevelOnTheGround)
{
    // E6 gives 0.4653 m for sixteen dominoes; there vertices of the next one's edge are already 5.9
    // mm inside, and the last of them leaves at 0.4882 m. For twenty-four the two agree.
    for (bool edgeSamples : {false, true}) {
        EXPECT_NEAR(touchingRadius(24, edgeSamples), 0.6372, 2e-4);
        EXPECT_NEAR(touchingRadius(16, edgeSamples), 0.4882, 2e-4);
    }

    for (int count : {24, 16}) {
        for (bool edgeSamples : {false, true}) {
            const double radius = touchingRadius(count, edgeSamples);
            const SceneGraph touching = graphOf(dominoRing(count, radius, edgeSamples));
            EXPECT_EQ(touching.graph.contact.size(), 2u);
            EXPECT_EQ(touching.graph.levels.componentCount, 2);
            EXPECT_EQ(touching.pairs.size(), 2u * count);

            const SceneGraph apart = graphOf(dominoRing(count, radius + 1e-3, edgeSamples));
            EXPECT_EQ(apart.graph.contact.size(), 2u);
            EXPECT_EQ(apart.graph.levels.componentCount, count + 1);
            EXPECT_EQ(apart.pairs.size(), static_cast<std::size_t>(count));
        }
    }
}

/// Stacks of unit cubes on one floor, 5 m apart.
World stacks(const std::vector<int>& heights, bool reversed = false)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    std::vector<Vec3> places;
    for (std::size_t s = 0; s < heights.size(); ++s) {
        for (int i = 0; i < heights[s]; ++i) {
            places.push_back({5.0 * static_cast<double>(s), 0.5 + i, 0.0});
        }
    }
    if (reversed) std::reverse(places.begin(), places.end());
    addPlane(world, material);
    for (const Vec3& place : places) {
        addBody(world, boxShape(Vec3::Ones(), 2), material, {place, Quat::Identity()});
    }
    return world;
}

std::vector<int> bodiesByLevel(const ContactGraph& graph)
{
    std::vector<int> counts;
    for (const ContactLevel& level : graph.contact) counts.push_back(level.bodies);
    return counts;
}

TEST(E6ContactGraph, AStackHasALevelForEveryCubeAndTwoStacksShareThem)
{
    EXPECT_EQ(bodiesByLevel(graphOf(stacks({6})).graph), (std::vector{0, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(bodiesByLevel(graphOf(stacks({5, 3})).graph), (std::vector{0, 2, 2, 2, 1, 1}));
}

TEST(E6ContactGraph, TheOrderOfTheBodiesDoesNotChangeIt)
{
    const ContactGraph forward = graphOf(stacks({5, 3})).graph;
    const ContactGraph backward = graphOf(stacks({5, 3}, true)).graph;
    EXPECT_EQ(bodiesByLevel(forward), bodiesByLevel(backward));
    EXPECT_EQ(forward.levels.level[1], backward.levels.level[8]);
    EXPECT_EQ(forward.levels.level[5], backward.levels.level[4]);
}

TEST(E6ContactGraph, ALintelLiesOneAboveTheHigherPillar)
{
    World world = stacks({3, 0, 0});
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addBody(world, boxShape({1.0, 3.0, 1.0}, 2), material, {{3.0, 1.5, 0.0}, Quat::Identity()});
    addBody(world, boxShape({5.0, 1.0, 1.0}, 4), material, {{1.5, 3.5, 0.0}, Quat::Identity()});
    const ContactGraph graph = graphOf(world).graph;
    EXPECT_EQ(graph.levels.level[3], 3);
    EXPECT_EQ(graph.levels.level[4], 1);
    EXPECT_EQ(graph.levels.level[5], 4);
}

TEST(E6ContactGraph, AHundredThousandNodesInAChainNeedNoDeepStack)
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

TEST(E6ContactGraph, ACycleIsOneComponentOneAboveWhatCarriesIt)
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
}  // namespace scree::test
