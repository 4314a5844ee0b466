// Departs from [GBF03 “Contact Graph”], which keeps the other bodies stationary while one falls:
// they drift with their present velocity here. For a heap at rest that is the same; on a lift, on a
// turntable or in free fall it is what makes the graph the heap's own.  [A36]
#include "core/dynamics/contact_graph.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace scree {
namespace {

/// Neighbours of every node in one array.
struct Adjacency {
    std::vector<std::uint32_t> start, target;

    Adjacency(std::size_t nodeCount, std::span<const SupportEdge> edges, bool transposed)
        : start(nodeCount + 1, 0), target(edges.size())
    {
        const auto tail = [&](const SupportEdge& e) { return transposed ? e.to : e.from; };
        const auto head = [&](const SupportEdge& e) { return transposed ? e.from : e.to; };
        for (const SupportEdge& e : edges) ++start[tail(e) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
        for (const SupportEdge& e : edges)
            target[next[tail(e)]++] = static_cast<std::uint32_t>(head(e));
    }
};

/// Depth-first searches that together see every node once.
class DepthFirst {
public:
    DepthFirst(const Adjacency& graph, std::size_t nodeCount) : graph_(graph), seen_(nodeCount, 0)
    {
    }
    bool hasSeen(std::uint32_t node) const { return seen_[node] != 0; }

    /// Appends to `finished` the nodes that are left for good on a search from `root`.
    void from(std::uint32_t root, std::vector<std::uint32_t>& finished)
    {
        seen_[root] = 1;
        stack_.push_back({root, graph_.start[root]});
        while (!stack_.empty()) {
            Visit& top = stack_.back();
            if (top.nextEdge == graph_.start[top.node + 1]) {
                finished.push_back(top.node);
                stack_.pop_back();
                continue;
            }
            const std::uint32_t next = graph_.target[top.nextEdge++];
            if (seen_[next]) continue;
            seen_[next] = 1;
            stack_.push_back({next, graph_.start[next]});
        }
    }

private:
    struct Visit {
        std::uint32_t node, nextEdge;
    };
    const Adjacency& graph_;
    std::vector<char> seen_;
    std::vector<Visit> stack_;
};

double deepestPhi(PairRecord& pair, const PlacedPair& placed)
{
    pair.proximity.place(placed, pair.tau);
    const std::optional<Touch> deepest = pair.proximity.next();
    return deepest ? deepest->phi : pair.tau;
}

/// Of the height of a fall: less may be what the field or rounding makes of a slide along it.
constexpr double kClearly = 0.1;

/// Whether the fall of one body takes it clearly away from one it overlaps.
bool leaves(PairRecord& pair, const PlacedPair& fallen, const PlacedPair& drifted,
            double fallHeight)
{
    if (!pair.proximity.interferes(drifted, pair.tau)) return false;
    return deepestPhi(pair, fallen) - deepestPhi(pair, drifted) > kClearly * fallHeight;
}

void findFalls(const World& world, double dt, StepScratch& scratch)
{
    parallelFor(scratch.pairCount, kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PairRecord& pair = scratch.pairs[i];
            const auto [a, b] = pair.bodies;
            const PlacedPair drifted =
                placePair(world, pair, scratch.driftPose[a], scratch.driftPose[b]);
            const auto test = [&](BodyId body, bool isUnmoved, const Pose& poseA, const Pose& poseB,
                                  bool& falls, bool& leavesIt) {
                const double fallHeight = dt * dt * scratch.forces[body].acceleration.norm();
                const PlacedPair fallen = placePair(world, pair, poseA, poseB);
                falls = world.mass[body].isMovable() && !isUnmoved &&
                        pair.proximity.interferes(fallen, pair.tau);
                leavesIt = falls && leaves(pair, fallen, drifted, fallHeight);
            };
            test(a, pair.aIsUnmoved, scratch.fallPose[a], scratch.driftPose[b], pair.aFallsOnB,
                 pair.aLeavesB);
            test(b, pair.bIsUnmoved, scratch.driftPose[a], scratch.fallPose[b], pair.bFallsOnA,
                 pair.bLeavesA);
        }
    });
}

/// Without any force nothing falls: of two bodies that touch the heavier carries the lighter,
/// equals carry each other.
void settleWeightless(const World& world, StepScratch& scratch)
{
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        PairRecord& pair = scratch.pairs[i];
        const double inverseA = pair.aIsUnmoved ? 0.0 : world.mass[pair.bodies.a].inverseMass;
        const double inverseB = pair.bIsUnmoved ? 0.0 : world.mass[pair.bodies.b].inverseMass;
        pair.aFallsOnB = pair.isTouched && inverseA >= inverseB;
        pair.bFallsOnA = pair.isTouched && inverseB >= inverseA;
    }
}

/// Levels by the falls found. Without the leaving edges a body rests on nothing that its fall takes
/// it away from.
GraphLevels levelsOf(const World& world, const StepScratch& scratch, bool withLeaving)
{
    std::vector<SupportEdge> edges;
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        const PairRecord& pair = scratch.pairs[i];
        const auto [a, b] = pair.bodies;
        const bool onB = pair.aFallsOnB && (withLeaving || !pair.aLeavesB);
        const bool onA = pair.bFallsOnA && (withLeaving || !pair.bLeavesA);
        if (onB && world.mass[a].isMovable()) edges.push_back({b, a});
        if (onA && world.mass[b].isMovable()) edges.push_back({a, b});
    }
    std::vector<char> isFixed(world.bodyCount());
    for (std::size_t b = 0; b < world.bodyCount(); ++b) isFixed[b] = !world.mass[b].isMovable();
    return computeLevels(world.bodyCount(), edges, isFixed);
}

/// Touching pairs that `takes` accepts, level by level, in processing order.
template <class Takes>
std::vector<ContactLevel> pairsByLevel(const World& world, const StepScratch& scratch,
                                       const GraphLevels& graph, bool freezeUnsupported,
                                       const Takes& takes)
{
    if (graph.level.empty()) return {};
    std::vector<ContactLevel> levels(1 + *std::max_element(graph.level.begin(), graph.level.end()));
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        ContactLevel& level = levels[graph.level[b]];
        ++level.bodies;
        if (graph.isSupported[b] || freezeUnsupported)
            level.supportedBodies.push_back(static_cast<BodyId>(b));
    }
    for (std::size_t i : scratch.pairOrder) {
        const PairRecord& pair = scratch.pairs[i];
        if (!pair.isTouched || !takes(pair)) continue;
        const int level = std::max(graph.level[pair.bodies.a], graph.level[pair.bodies.b]);
        levels[level].pairs.push_back(i);
    }
    return levels;
}

/// Whether no edge leads down and those inside a level only join what is one component.
bool riseAlongEdges(const GraphLevels& levels, std::span<const SupportEdge> edges)
{
    return std::ranges::all_of(edges, [&](const SupportEdge& edge) {
        const bool isInside = levels.component[edge.from] == levels.component[edge.to];
        return isInside ? levels.level[edge.from] == levels.level[edge.to]
                        : levels.level[edge.from] < levels.level[edge.to];
    });
}

/// Whether every movable body is in one level and every resting pair is worked on in one.
bool arePartition(const std::vector<ContactLevel>& levels, const World& world,
                  const StepScratch& scratch)
{
    std::ptrdiff_t bodies = std::ranges::count_if(world.mass, &BodyMass::isMovable);
    std::vector<int> visits(scratch.pairCount, 0);
    for (const ContactLevel& level : levels) {
        bodies -= level.bodies;
        for (const std::size_t pair : level.pairs) ++visits[pair];
    }
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        const PairRecord& pair = scratch.pairs[i];
        const bool rests = pair.isTouched && (pair.aFallsOnB || pair.bFallsOnA);
        if (visits[i] != rests) return false;
    }
    return bodies == 0;
}

}  // namespace

GraphLevels computeLevels(std::size_t nodeCount, std::span<const SupportEdge> edges,
                          std::span<const char> isFixed)
{
    const Adjacency forward(nodeCount, edges, false);
    const Adjacency backward(nodeCount, edges, true);

    // Two searches: finish order on the graph, then the transpose in decreasing finish time. The
    // components come out in topological order of the collapsed graph.
    DepthFirst forwards(forward, nodeCount), backwards(backward, nodeCount);
    std::vector<std::uint32_t> finished;
    finished.reserve(nodeCount);
    for (std::uint32_t n = 0; n < nodeCount; ++n) {
        if (!forwards.hasSeen(n)) forwards.from(n, finished);
    }
    GraphLevels result;
    result.component.assign(nodeCount, -1);
    std::vector<std::uint32_t> members;  // component by component
    members.reserve(nodeCount);
    std::vector<std::size_t> first{0};  // of each component in `members`
    for (auto n = finished.rbegin(); n != finished.rend(); ++n) {
        if (backwards.hasSeen(*n)) continue;
        backwards.from(*n, members);
        for (std::size_t m = first.back(); m < members.size(); ++m)
            result.component[members[m]] = result.componentCount;
        ++result.componentCount;
        first.push_back(members.size());
    }

    std::vector<int> levelOf(result.componentCount, 0);
    std::vector<char> supported(result.componentCount, 0);
    for (int c = 0; c < result.componentCount; ++c) {
        const std::span nodes(members.data() + first[c], members.data() + first[c + 1]);
        for (std::uint32_t n : nodes) supported[c] |= isFixed[n];
        for (std::uint32_t n : nodes) {
            for (std::uint32_t e = forward.start[n]; e < forward.start[n + 1]; ++e) {
                const int next = result.component[forward.target[e]];
                if (next == c) continue;
                levelOf[next] = std::max(levelOf[next], levelOf[c] + 1);
                supported[next] |= supported[c];
            }
        }
    }
    result.level.resize(nodeCount);
    result.isSupported.resize(nodeCount);
    for (std::size_t n = 0; n < nodeCount; ++n) {
        result.level[n] = levelOf[result.component[n]];
        result.isSupported[n] = supported[result.component[n]];
    }
    SCREE_VALIDATE(riseAlongEdges(result, edges), "a body is no higher than what it rests on");
    return result;
}

std::vector<PairVisit> visitsUpward(const std::vector<ContactLevel>& levels, int iterations)
{
    std::vector<PairVisit> visits;
    for (std::size_t level = 0; level < levels.size(); ++level) {
        for (int l = 1; l <= iterations; ++l) {
            for (const std::size_t pair : levels[level].pairs)
                visits.push_back({pair, static_cast<int>(level), l});
        }
    }
    return visits;
}

FrozenBodies::FrozenBodies(const std::vector<ContactLevel>& levels, std::size_t bodyCount)
    : frozenFrom_(bodyCount, std::numeric_limits<int>::max())
{
    for (std::size_t level = 0; level < levels.size(); ++level) {
        for (const BodyId body : levels[level].supportedBodies)
            frozenFrom_[body] = static_cast<int>(level) + 1;
    }
}

ContactGraph buildContactGraph(const World& world, const StepSettings& settings, double dt,
                               StepScratch& scratch)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        predictBody(world, settings, dt, static_cast<BodyId>(b), scratch);
    }
    const bool isWeightless =
        std::all_of(scratch.forces.begin(), scratch.forces.end(), [](const AppliedForce& force) {
            return force.acceleration.isZero(0.0) && force.torque.isZero(0.0);
        });
    if (isWeightless) {
        settleWeightless(world, scratch);
    } else {
        findFalls(world, dt, scratch);
    }

    ContactGraph graph;
    // With collisions switched off nothing has answered the approach of two bodies, and each falls
    // into the other: counted both ways, shock could not tell the weight that fell from the plank
    // it fell on.  [E4, weight control]
    const bool withLeaving = settings.collisionIterations > 0;
    graph.levels = levelsOf(world, scratch, withLeaving);
    const bool freezeUnsupported = settings.freezeUnsupported;
    graph.contact =
        pairsByLevel(world, scratch, graph.levels, freezeUnsupported,
                     [](const PairRecord& pair) { return pair.aFallsOnB || pair.bFallsOnA; });
    SCREE_VALIDATE(arePartition(graph.contact, world, scratch), "levels of contact");
    graph.overlap = pairsByLevel(world, scratch, levelsOf(world, scratch, false), freezeUnsupported,
                                 [](const PairRecord&) { return true; });
    for (const ContactLevel& level : graph.contact) {
        graph.contactPairs += static_cast<std::int64_t>(level.pairs.size());
    }
    return graph;
}

}  // namespace scree
