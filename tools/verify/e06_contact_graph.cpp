// E6: who rests on whom. [GBF03 “Contact Graph”], [A36–A38, A54]  The scenes that the solver's
// order or radius must be varied in are built here in code; the ring of dominoes is also a shot.
#include <algorithm>
#include <set>

#include "core/base/disjoint_sets.h"
#include "core/collision/convex_overlap.h"
#include "core/collision/interference.h"
#include "core/collision/near_features.h"
#include "core/diagnostics/step_observer.h"
#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tools/cpu_time.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

struct SceneGraph {
    std::vector<int> level;                     // per body
    int levels = 0, components = 0;             // the ground's among them
    std::set<std::pair<BodyId, BodyId>> pairs;  // that contact processes, or that bear
};

constexpr double kStep = 1.0 / 240.0;

SceneGraph graphOfPaper(World world, const StepSettings& settings)
{
    StepScratch scratch;
    findPairs(world, settings, kStep, scratch);
    beginStep(world, settings, kStep, scratch);
    resolveCollisions(world, settings, kStep, scratch);
    const ContactGraph graph = buildContactGraph(world, settings, kStep, scratch);
    SceneGraph result{{graph.levels.level.begin(), graph.levels.level.end()},
                      static_cast<int>(graph.contact.size()),
                      graph.levels.componentCount,
                      {}};
    for (const ContactLevel& level : graph.contact) {
        for (std::size_t i : level.pairs) {
            result.pairs.insert({scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b});
        }
    }
    return result;
}

/// As a step of method scree shows itself.
SceneGraph graphOfScree(World world, const StepSettings& settings)
{
    Stepper stepper(settings);
    LastStep last;
    stepper.observe(&last);
    SceneGraph result;
    result.levels = stepper.step(world, kStep).levels;
    result.level.assign(last.seen.level.begin(), last.seen.level.end());
    DisjointSets sets(world.bodyCount());
    const auto isMovable = [&](BodyId body) { return world.mass[body].isMovable(); };
    for (const ContactSeen& contact : last.seen.contacts) {
        result.pairs.insert({contact.a, contact.b});
        if (isMovable(contact.a) && isMovable(contact.b)) sets.join(contact.a, contact.b);
    }
    result.components = 1;
    for (std::size_t b = 0; b < world.bodyCount(); ++b)
        result.components += isMovable(static_cast<BodyId>(b)) && sets.find(b) == b;
    return result;
}

SceneGraph graphOf(const Context& context, const World& world, std::uint64_t seed = 1)
{
    StepSettings settings;
    settings.method = methodOf(context);
    settings.gravity = {0.0, -9.8, 0.0};
    settings.seed = seed;
    return settings.method == Method::paper ? graphOfPaper(world, settings)
                                            : graphOfScree(world, settings);
}

World emptyFloor()
{
    World world;
    const MaterialId material = world.addMaterial({"material", 1.0, 0.5, 0.3});
    BodyDefinition floor;
    floor.name = "floor";
    floor.shape = world.addShape(buildPlaneShape("plane"));
    floor.material = material;
    floor.kind = BodyKind::fixed;
    world.addBody(floor);
    return world;
}

void add(World& world, ShapeId shape, const Pose& pose)
{
    BodyDefinition definition;
    definition.name = "body_" + std::to_string(world.bodyCount());
    definition.shape = shape;
    definition.worldFromAsset = pose;
    definition.mass = 1.0;
    world.addBody(definition);
}

/// Dominoes 0.4 × 1 × 0.1 m in a circle on a floor, each leaning 30° along the circle onto the
/// next.
World dominoRing(const std::shared_ptr<const Shape>& domino, int count, double radius)
{
    World world = emptyFloor();
    const ShapeId shape = world.addShape(domino);
    const double lean = kPi / 6.0;
    double s = 0.0, c = 0.0;
    sinCos(lean, s, c);
    for (int i = 0; i < count; ++i) {
        const Quat around = exponentialMap({0.0, -2.0 * kPi * i / count, 0.0});
        const Vec3 centre = around * Vec3(radius, 0.5 * c + 0.05 * s, 0.0);
        add(world, shape, {centre, around * exponentialMap({lean, 0.0, 0.0})});
    }
    return world;
}

/// By the samples of method paper.
bool interfere(const PlacedPair& pair)
{
    std::vector<Touch> touches;
    findTouchesPlainly(pair, 1e-9, touches);
    return !touches.empty();
}

/// By the features of method scree.
bool touch(const PlacedPair& pair)
{
    std::vector<GapContact> contacts;
    NearFeatures().findContacts(pair, 0.0, contacts);
    return !contacts.empty();
}

/// By the theorem of the separating axis, of boxes.
bool overlap(const PlacedPair& pair)
{
    const Pose bFromA = inverse(pair.worldFromB) * pair.worldFromA;
    return overlapOfConvex(
               {*pair.shapeA, *pair.shapeB, bFromA.orientation.toRotationMatrix(), bFromA.position})
        .has_value();
}

/// The largest radius at which neighbours still meet, by bisection.
template <class Meet>
double touchingRadius(const std::shared_ptr<const Shape>& domino, int count, const Meet& meet)
{
    double inside = 0.2, outside = 2.0;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (inside + outside);
        const World world = dominoRing(domino, count, middle);
        const PlacedPair pair{&world.shapeOf(1), &world.shapeOf(2), world.motion[1].worldFromBody(),
                              world.motion[2].worldFromBody()};
        (meet(pair) ? inside : outside) = middle;
    }
    return inside;
}

double touchingRadius(const Context& context, const std::shared_ptr<const Shape>& domino, int count)
{
    return methodOf(context) == Method::paper ? touchingRadius(domino, count, interfere)
                                              : touchingRadius(domino, count, touch);
}

void dominoes(const Context& context, Findings& findings)
{
    const bool isPaper = methodOf(context) == Method::paper;
    for (bool edgeSamples : isPaper ? std::vector{false, true} : std::vector{false}) {
        ShapeSettings settings;
        settings.edgeSamples = edgeSamples;
        const auto domino =
            buildMeshShape("domino", makeBox({0.4, 1.0, 0.1}, {8, 20, 2}), settings);
        const std::string samples = edgeSamples ? " with edge samples" : "";
        for (const auto& [count, radius] : {std::pair{24, 0.6372}, std::pair{16, 0.4653}}) {
            const std::string name = std::to_string(count) + " dominoes" + samples;
            const double found = touchingRadius(context, domino, count);
            if (isPaper) {
                findings.near(count == 24 ? must : departure, name + ": radius of the first touch",
                              found, radius, 2e-4, "m",
                              count == 24 ? ""
                                          : "at the radius the experiment gives, vertices are "
                                            "already 5.9 mm inside the next; the last leaves at "
                                            "0.4882 m");
            } else {
                findings.near(must, name + ": radius of the first touch", found,
                              touchingRadius(domino, count, overlap), 1e-6, "m",
                              "of boxes: their edges meet before any of their samples do");
                findings.near(departure, name + ": radius at which samples first touch", found,
                              radius, 2e-4, "m", "this method knows no samples");
            }
            const SceneGraph touching = graphOf(context, dominoRing(domino, count, found));
            findings.equal(must, name + ": levels", touching.levels, 2);
            findings.equal(must, name + ": components", touching.components, 2);
            findings.equal(must, name + ": pairs", touching.pairs.size(), 2.0 * count);
            const SceneGraph apart = graphOf(context, dominoRing(domino, count, found + 1e-3));
            findings.equal(must, name + " 1 mm farther out: components", apart.components,
                           count + 1);
            findings.equal(must, name + " 1 mm farther out: pairs", apart.pairs.size(), count);
            findings.equal(must, name + " 1 mm farther out: levels", apart.levels, 2);
        }
    }
    const auto exact = buildExactShape("domino", ExactSolid::box({0.4, 1.0, 0.1}),
                                       makeBox({0.4, 1.0, 0.1}, {8, 20, 2}));
    const SceneGraph ring =
        graphOf(context, dominoRing(exact, 24, touchingRadius(context, exact, 24)));
    findings.equal(must, "24 dominoes, exact boxes: levels", ring.levels, 2);
    findings.equal(must, "24 dominoes, exact boxes: pairs", ring.pairs.size(), 48);
    ShotRun shot(context, "../dominoes");
    const SceneGraph graph = graphOf(context, shot.world);
    findings.equal(must, "shots/dominoes.toml: levels", graph.levels, 2);
    findings.equal(must, "shots/dominoes.toml: pairs", graph.pairs.size(), 48);
    addPicture(context, shot, "Twenty-four dominoes, each leaning on the next: one level",
               findings);
}

/// Stacks of unit cubes on one floor, 5 m apart.
World stacks(const std::vector<int>& heights, bool isReversed = false)
{
    static const auto cube = buildMeshShape("cube", makeBox(Vec3::Ones(), {2, 2, 2}));
    std::vector<Vec3> places;
    for (std::size_t s = 0; s < heights.size(); ++s) {
        for (int i = 0; i < heights[s]; ++i) {
            places.push_back({5.0 * static_cast<double>(s), 0.5 + i, 0.0});
        }
    }
    if (isReversed) std::reverse(places.begin(), places.end());
    World world = emptyFloor();
    const ShapeId shape = world.addShape(cube);
    for (const Vec3& place : places) add(world, shape, {place, Quat::Identity()});
    return world;
}

/// Movable bodies by level, as digits: "022211".
std::string levelSizes(const Context& context, const World& world, std::uint64_t seed = 1)
{
    const SceneGraph graph = graphOf(context, world, seed);
    std::vector<int> bodies(static_cast<std::size_t>(graph.levels), 0);
    for (std::size_t b = 0; b < graph.level.size(); ++b) {
        if (world.mass[b].isMovable()) ++bodies.at(static_cast<std::size_t>(graph.level[b]));
    }
    std::string sizes;
    for (int count : bodies) sizes += std::to_string(count);
    return sizes;
}

void cubes(const Context& context, Findings& findings)
{
    findings.equal(must, "a stack of six: a level for each cube",
                   levelSizes(context, stacks({6})) == "0111111", 1);
    int wrong = 0;
    const std::uint64_t seeds = context.isFull() ? 100 : 20;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        wrong += levelSizes(context, stacks({5, 3}), seed) != "022211";
        wrong += levelSizes(context, stacks({5, 3}, true), seed) != "022211";
    }
    findings.equal(must,
                   "stacks of 5 and 3, either order of bodies, " + std::to_string(seeds) +
                       " seeds: graphs unlike 2, 2, 2, 1, 1",
                   wrong, 0);

    World arch = stacks({3});
    add(arch, arch.addShape(buildMeshShape("pillar", makeBox({1.0, 3.0, 1.0}, {2, 2, 2}))),
        {{3.0, 1.5, 0.0}, Quat::Identity()});
    add(arch, arch.addShape(buildMeshShape("lintel", makeBox({5.0, 1.0, 1.0}, {4, 4, 4}))),
        {{1.5, 3.5, 0.0}, Quat::Identity()});
    findings.equal(must, "arch: level of the lintel, one above the higher pillar",
                   graphOf(context, arch).level[5], 4);
}

/// Levels of the cubes of two stacks that ride on a keyed floor, in the order of the bodies.
std::string levelsOnTheRide(const Context& context, std::uint64_t seed, bool isReversed)
{
    std::vector<std::string> overrides = {"shot.seed=" + std::to_string(seed)};
    if (isReversed) {
        overrides.emplace_back("body.five.grid.spacing=[0, -1, 0]");
        overrides.emplace_back("body.three.grid.spacing=[0, -1, 0]");
    }
    ShotRun run(context, "E06_moving_floor", overrides);
    return levelsInAFrame(run);
}

void onAMovingFloor(const Context& context, Findings& findings)
{
    int wrong = 0;
    const std::uint64_t seeds = context.isFull() ? 100 : 5;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        wrong += levelsOnTheRide(context, seed, false) != "12345123";
        wrong += levelsOnTheRide(context, seed, true) != "54321321";
    }
    findings.equal(must,
                   "stacks of 5 and 3 riding on a floor at 3.6 m/s, either order, " +
                       std::to_string(seeds) + " seeds: other levels than at rest",
                   wrong, 0);
    ShotRun dominoes(context, "../dominoes");
    int levels = 0;
    dominoes.advanceFrames(1, [&](const FrameReport& report) { levels = report.sum.levels; });
    findings.equal(must, "shots/dominoes.toml, a frame with all defaults: levels", levels, 2);
}

/// A search that called itself from node to node would need a stack as deep.
void chain(Findings& findings)
{
    constexpr int kNodes = 100000;
    std::vector<SupportEdge> edges;
    for (int i = 0; i + 1 < kNodes; ++i) edges.push_back({i, i + 1});
    std::vector<char> isFixed(kNodes, 0);
    isFixed[0] = 1;
    const double before = cpuSeconds();
    const GraphLevels levels = computeLevels(kNodes, edges, isFixed);
    const double seconds = cpuSeconds() - before;
    findings.equal(must, "chain of 100 000 nodes: level of the last", levels.level.back(),
                   kNodes - 1);
    findings.atMost(must, "chain of 100 000 nodes: processor time", seconds, 1.0, "s");
}

}  // namespace

void runContactGraph(const Context& context, Findings& findings)
{
    dominoes(context, findings);
    cubes(context, findings);
    chain(findings);
    onAMovingFloor(context, findings);
}

}  // namespace scree::verify
