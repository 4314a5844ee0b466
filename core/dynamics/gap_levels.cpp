// Levels by the individual fall: a row is an edge when one of its bodies, falling alone, would
// close it. A gap says so without moving anything. What runs into something goes on beside it from
// there, as collisions leave it in the paper: with the speed of a fall as well each of the two
// would seem to rest on the other, shock would pin neither, and 8 t went through the kilogram on
// which they landed.
#include "core/dynamics/gap_levels.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/contact_graph.h"

namespace scree {

int levelOf(const GapLevels& levels, BodyPair bodies)
{
    return std::max(levels.level[bodies.a], levels.level[bodies.b]);
}

void findLevels(double dt, const GapBlock& block, GapScratch& scratch)
{
    forPairs(block, [&](std::size_t i) {
        GapPair& pair = scratch.pairs[i];
        const GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            const GapRow& row = scratch.rows[r];
            const double end = std::max(row.gap, 0.0) + shiftAt(row, a, b) +
                               dt * velocityAt(row, a, b).dot(row.normal);
            // Blows of so different masses may be far from answered when their rounds are over.
            const double drift = row.wasHit ? 0.0 : std::max(end, 0.0);
            const double fallOfA = dt * dt * a.pull.dot(row.normal);
            const double fallOfB = dt * dt * b.pull.dot(row.normal);
            pair.fallsOnB |= row.movesA && drift + fallOfA < 0.0;
            pair.fallsOnA |= row.movesB && drift - fallOfB < 0.0;
        }
    });
    // Node 0 is all that cannot be moved: nothing of it rests on anything.
    std::vector<char> isFixed(block.bodies.size() + 1, 0);
    isFixed[0] = 1;
    std::vector<SupportEdge> edges;
    edges.reserve(2 * block.pairs.size());
    for (const std::size_t i : block.pairs) {
        const GapPair& pair = scratch.pairs[i];
        const BodyId a = scratch.placeInBlock[pair.bodies.a];
        const BodyId b = scratch.placeInBlock[pair.bodies.b];
        if (pair.fallsOnB) edges.push_back({b, a});
        if (pair.fallsOnA) edges.push_back({a, b});
    }
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
        scratch.levels.isSupported[i] = scratch.bodies[i].inverseMass == 0.0;
    }
}

}  // namespace scree
