// Symbols: u relative velocity at a row.
#include "core/dynamics/gaps/gap_forces.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/parallel.h"

namespace scree {
namespace {

/// What closes, or has borne, less than this share of what gravity does in a step stops nothing: of
/// boxes that had been thrown up together the one bore the other by rounding, and for that both
/// fell a little too far, on the lift that they had just left.
constexpr double kStops = 1e-4;

/// How far the surfaces at a row are from each other at the end of the step, if a pull acts on A
/// against B that nothing answers [m].
double endOfRow(const GapRow& row, const GapBody& a, const GapBody& b, const Vec3& pull, double dt)
{
    const double u = velocityAt(row, a, b).dot(row.normal);
    return openAt(row, a, b) + dt * (u + 0.5 * dt * pull.dot(row.normal));
}

/// What rests on what is stopped is stopped too. What pulls at both alike does not tell of that:
/// all of a tower but its lowest layer was to fall freely in its first step, with weights handed
/// down that were to hold it. Where something has carried before, that tells.
void stopWhatRestsOnStopped(double dt, const GapIsland& island, GapScratch& scratch)
{
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
        if (a.isStopped == b.isStopped) continue;
        const Vec3 pull = a.isStopped ? Vec3(-b.pull) : a.pull;
        const auto rows = scratch.rowsOf(pair);
        const bool rests = std::ranges::any_of(rows, [&](const GapRow& row) {
            const bool isMoved = a.isStopped ? row.movesB : row.movesA;
            return isMoved && endOfRow(row, a, b, pull, dt) < -kStops * dt * dt * pull.norm();
        });
        if (rests) a.isStopped = b.isStopped = true;
    }
}

/// What pulls a body throughout the step, and how far that does not move it: in the whole step if
/// nothing stops it, else until it was hit, if nothing bore it.
void addForces(double dt, GapBody& body)
{
    body.velocityBefore = body.velocity;
    body.spinBefore = body.spin;
    if (!body.isMovable()) return;
    const Vec3 turning = body.inverseInertia * body.torque;
    body.velocity += dt * body.pull;
    body.spin += dt * turning;
    body.angularImpulse += dt * body.torque;
    const double fallen = !body.isStopped ? dt : body.isHeld ? 0.0 : body.hitAt;
    body.shift -= 0.5 * fallen * fallen * body.pull;
    body.turn -= 0.5 * fallen * fallen * turning;
}

}  // namespace

void addForcesToGaps(double dt, const GapBlock& block, GapScratch& scratch)
{
    // A body that nothing stops within the step falls on a parabola: end-of-step velocity takes it
    // g dt²/2 too far.
    std::vector<char> stops(block.pairs.size(), 0);
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        char& stopsAny = stops[pair.place];
        for (std::size_t r = pair.begin; r < pair.end && !stopsAny; ++r) {
            const GapRow& row = scratch.rows[r];
            const GapBody& a = scratch.bodies[row.a];
            const GapBody& b = scratch.bodies[row.b];
            const double end = endOfRow(row, a, b, a.pull - b.pull, dt);
            const double little = kStops * dt * std::max(a.pull.norm(), b.pull.norm());
            stopsAny = end < -dt * little ||
                       (row.impulse.x() + row.squeeze) * row.inverseNormalMass > little;
        }
    });
    for (std::size_t n = 0; n < stops.size(); ++n) {
        const GapPair& pair = scratch.pairs[block.pairs[n]];
        for (const BodyId id : {pair.bodies.a, pair.bodies.b}) {
            if (scratch.placeInBlock[id] == 0) continue;
            GapBody& body = scratch.bodies[id];
            body.isStopped = body.isStopped || stops[n];
            body.isHeld = body.isHeld || pair.isCarried;
        }
    }
    forIslands(scratch, block, [&](std::size_t i) {
        const GapIsland& island = scratch.islands[i];
        if (!island.isRemembered) stopWhatRestsOnStopped(dt, island, scratch);
    });
    forEach(block.bodies.size(), kShortWork,
            [&](std::size_t n) { addForces(dt, scratch.bodies[block.bodies[n]]); });
    forPairs(block, [&](std::size_t i) {
        for (GapRow& row : scratch.rowsOf(scratch.pairs[i])) {
            const double open = openAt(row, scratch.bodies[row.a], scratch.bodies[row.b]);
            row.target = -std::max(open, 0.0) / dt;
        }
    });
}

double strongestPull(const GapScratch& scratch, const GapIsland& island)
{
    double strongest = 0.0;
    for (const BodyId body : island.movers)
        strongest = std::max(strongest, scratch.bodies[body].pull.squaredNorm());
    return std::sqrt(strongest);
}

/// What is the same for all is so to the bit: of ties the order depends on it.
Vec3 meanPull(const GapScratch& scratch, const GapIsland& island)
{
    const Vec3 first = scratch.bodies[island.movers.front()].pull;
    Vec3 others = Vec3::Zero();
    for (const BodyId body : island.movers) others += scratch.bodies[body].pull - first;
    return first + others / static_cast<double>(island.movers.size());
}

void addForcesToOthers(double dt, GapScratch& scratch)
{
    forEach(scratch.bodies.size(), kShortWork, [&](std::size_t b) {
        if (scratch.placeInBlock[b] == 0 && !scratch.bodies[b].isKept)
            addForces(dt, scratch.bodies[b]);
    });
}

}  // namespace scree
