// Levels by the individual fall: a row is an edge when one of its bodies, falling alone, would
// close it. A gap says so without moving anything. What runs into something goes on beside it from
// there, as collisions leave it in the paper: with the speed of a fall as well each of the two
// would seem to rest on the other, shock would pin neither, and 8 t went through the kilogram on
// which they landed.
#include "core/dynamics/gaps/gap_levels.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/contact_graph.h"

namespace scree {
namespace {

/// What falls into another by less than this share of its fall passes along it. Of the bricks of a
/// tower, flush in their layers, each was to rest on its neighbour, by the rounding of normals: of
/// 18 layers it had 54 levels.
constexpr double kFalls = 1e-4;

/// What takes less than this share of what bears a body most only leans on it. Books pushed along
/// their shelf lean on each other by a thousandth, and each was to rest on the next: pushes drove
/// them back into what pushed them, the "highest" first, 15 mm deep.
constexpr double kBears = 0.1;

/// The share of its fall by which falling alone takes a body into what is `drift` away along
/// `normal`, out of that; 0 if it does not.
double shareOfFall(double drift, const Vec3& pull, const Vec3& normal, double dt)
{
    const double fall = dt * dt * pull.norm();
    const double into = -(drift + dt * dt * pull.dot(normal));
    return into > kFalls * fall ? into / fall : 0.0;
}

}  // namespace

int levelOf(const GapLevels& levels, BodyPair bodies)
{
    return std::max(levels.level[bodies.a], levels.level[bodies.b]);
}

void findLevels(double dt, const GapBlock& block, GapScratch& scratch)
{
    forPairs(block, [&](std::size_t i) {
        GapPair& pair = scratch.pairs[i];
        const GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
        for (const GapRow& row : scratch.rowsOf(pair)) {
            const double end = openAt(row, a, b) + dt * velocityAt(row, a, b).dot(row.normal);
            // Blows of so different masses may be far from answered when their rounds are over.
            const double drift = row.wasHit ? 0.0 : std::max(end, 0.0);
            if (row.movesA)
                pair.fallOnB = std::max(pair.fallOnB, shareOfFall(drift, a.pull, row.normal, dt));
            if (row.movesB)
                pair.fallOnA = std::max(pair.fallOnA, shareOfFall(drift, b.pull, -row.normal, dt));
        }
    });
    // Node 0 is all that cannot be moved: nothing of it rests on anything.
    std::vector<char> isFixed(block.bodies.size() + 1, 0);
    isFixed[0] = 1;
    std::vector<SupportEdge> edges;
    edges.reserve(2 * block.pairs.size());
    std::vector<double> most(isFixed.size(), 0.0);
    const auto forFalls = [&](const auto& work) {
        for (const std::size_t i : block.pairs) {
            const GapPair& pair = scratch.pairs[i];
            const BodyId a = scratch.placeInBlock[pair.bodies.a];
            const BodyId b = scratch.placeInBlock[pair.bodies.b];
            if (pair.fallOnB > 0.0) work(b, a, pair.fallOnB);
            if (pair.fallOnA > 0.0) work(a, b, pair.fallOnA);
        }
    };
    forFalls(
        [&](BodyId, BodyId upper, double share) { most[upper] = std::max(most[upper], share); });
    forFalls([&](BodyId lower, BodyId upper, double share) {
        if (share >= kBears * most[upper]) edges.push_back({lower, upper});
    });
    const GraphLevels graph = computeLevels(isFixed.size(), edges, isFixed);
    for (std::size_t n = 0; n < block.bodies.size(); ++n) {
        scratch.levels.level[block.bodies[n]] = graph.level[n + 1];
        scratch.levels.isSupported[block.bodies[n]] = graph.isSupported[n + 1];
    }
}

void levelOthers(GapScratch& scratch)
{
    scratch.levels.level.resize(scratch.bodies.size());
    scratch.levels.isSupported.resize(scratch.bodies.size());
    for (std::size_t i = 0; i < scratch.bodies.size(); ++i) {
        if (scratch.placeInBlock[i] > 0 || scratch.bodies[i].isKept) continue;
        scratch.levels.level[i] = 0;
        scratch.levels.isSupported[i] = !scratch.bodies[i].isMovable();
    }
}

}  // namespace scree
