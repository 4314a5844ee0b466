#include "core/dynamics/gap_held.h"

namespace scree {

std::vector<Held> heldAsBefore(double dt, const GapScratch& scratch)
{
    struct OfPair {
        Vec3 impulse = Vec3::Zero(), turnOfA = Vec3::Zero(), turnOfB = Vec3::Zero();  // on A, on B
    };
    std::vector<OfPair> ofPairs(scratch.pairs.size());
    forOpenPairs(scratch, [&](std::size_t p) {
        for (std::size_t r = scratch.pairs[p].begin; r < scratch.pairs[p].end; ++r) {
            const GapRow& row = scratch.rows[r];
            if (row.impulse.x() == 0.0) continue;
            const Vec3 impulse = row.worldImpulse();
            ofPairs[p].impulse += impulse;
            ofPairs[p].turnOfA += row.rA.cross(impulse) + row.couple;
            ofPairs[p].turnOfB -= row.rB.cross(impulse) + row.couple;
        }
    });
    std::vector<Held> held(scratch.bodies.size());
    forIslands(scratch, [&](std::size_t i) {
        for (const std::size_t p : scratch.islands[i].pairs) {
            const GapRow& any = scratch.rows[scratch.pairs[p].begin];
            if (any.movesA) {
                held[any.a].acceleration += ofPairs[p].impulse;
                held[any.a].turning += ofPairs[p].turnOfA;
            }
            if (any.movesB) {
                held[any.b].acceleration -= ofPairs[p].impulse;
                held[any.b].turning += ofPairs[p].turnOfB;
            }
        }
    });
    forEach(held.size(), kShortWork, [&](std::size_t b) {
        held[b].acceleration *= scratch.bodies[b].inverseMass / dt;
        held[b].turning = scratch.bodies[b].inverseInertia * held[b].turning / dt;
    });
    return held;
}

}  // namespace scree
