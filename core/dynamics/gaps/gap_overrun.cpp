// Symbols: u normal velocity (approaching < 0).
#include "core/dynamics/gaps/gap_overrun.h"

#include <algorithm>

#include "core/dynamics/body_pairs.h"

namespace scree {
namespace {

/// What nobody sees, as a share of the smaller body.
constexpr double kVisible = 1e-3;

/// How deep in each other two surfaces are when the step ends [m].
double overrun(const GapRow& row, const GapBody& a, const GapBody& b, double dt)
{
    // What still closes is stopped by contacts.
    const double u = std::max(velocityAt(row, a, b).dot(row.normal), 0.0);
    return -(openAt(row, a, b) + dt * u);
}

/// True if a body was made to move otherwise.
bool endOverrunsOf(const GapPair& pair, double visible, double dt, GapScratch& scratch)
{
    GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
    if (a.hitAt == 0.0 && b.hitAt == 0.0) return false;
    bool isChanged = false;
    for (const GapRow& row : scratch.rowsOf(pair)) {
        // Not the other way round: of what is no number nothing is taken back, for ever.
        if (!(overrun(row, a, b, dt) > visible)) continue;
        const double ofA = row.normal.dot(a.shift + a.turn.cross(row.rA));
        const double ofB = -row.normal.dot(b.shift + b.turn.cross(row.rB));
        if (ofA < 0.0) moveFromTheStart(a);
        if (ofB < 0.0) moveFromTheStart(b);
        isChanged = true;
    }
    return isChanged;
}

}  // namespace

void moveFromTheStart(GapBody& body)
{
    body.shift = body.turn = Vec3::Zero();
    body.hitAt = 0.0;
}

void endOverruns(const World& world, double dt, const GapBlock& block, GapScratch& scratch)
{
    forIslands(scratch, block, [&](std::size_t i) {
        // Each time a body more has nothing left to be taken back.
        bool isChanged = true;
        while (isChanged) {
            isChanged = false;
            for (const std::size_t p : scratch.islands[i].pairs) {
                const GapPair& pair = scratch.pairs[p];
                const double visible =
                    kVisible * smallerRadius(world, pair.bodies.a, pair.bodies.b);
                isChanged = endOverrunsOf(pair, visible, dt, scratch) || isChanged;
            }
        }
    });
}

}  // namespace scree
