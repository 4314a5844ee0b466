#include "core/dynamics/gaps/gap_held.h"

namespace scree {

const std::vector<Held>& heldAsBefore(double dt, GapBlock& block, const GapScratch& scratch)
{
    block.heldByPairs.assign(block.pairs.size(), {});
    forPairs(block, [&](std::size_t p) {
        const GapPair& pair = scratch.pairs[p];
        HeldByPair& sum = block.heldByPairs[pair.place];
        for (const GapRow& row : scratch.rowsOf(pair)) {
            if (!row.carries()) continue;
            const Vec3 impulse = row.worldImpulse();
            sum.impulse += impulse;
            sum.turnOfA += row.rA.cross(impulse) + row.couple;
            sum.turnOfB -= row.rB.cross(impulse) + row.couple;
        }
    });
    std::vector<Held>& held = block.held;
    held.assign(block.bodies.size() + 1, {});
    forIslands(scratch, block, [&](std::size_t i) {
        for (const std::size_t p : scratch.islands[i].pairs) {
            const GapRow& any = scratch.rows[scratch.pairs[p].begin];
            const HeldByPair& sum = block.heldByPairs[scratch.pairs[p].place];
            if (any.movesA) {
                Held& a = held[scratch.placeInBlock[any.a]];
                a.acceleration += sum.impulse;
                a.turning += sum.turnOfA;
            }
            if (any.movesB) {
                Held& b = held[scratch.placeInBlock[any.b]];
                b.acceleration -= sum.impulse;
                b.turning += sum.turnOfB;
            }
        }
    });
    forEach(block.bodies.size(), kShortWork, [&](std::size_t n) {
        const GapBody& body = scratch.bodies[block.bodies[n]];
        held[n + 1].acceleration *= body.inverseMass / dt;
        held[n + 1].turning = body.inverseInertia * held[n + 1].turning / dt;
    });
    return held;
}

}  // namespace scree
