#include "core/dynamics/gap_kept.h"

#include <algorithm>
#include <limits>

namespace scree {

SolvedIslands::SolvedIslands(const GapScratch& scratch)
    : pairs_(scratch.pairs), bodies_(scratch.bodies), impacts_(scratch.impacts)
{
    for (const GapIsland& island : scratch.islands) pairsOfIsland_.push_back(island.pairs.size());
    rows_.reserve(scratch.rows.size());
    for (const GapRow& row : scratch.rows)
        rows_.push_back({row.impulse, row.couple, row.target, row.wasHit});
}

const GapPair* SolvedIslands::find(BodyPair bodies) const
{
    const auto found = std::ranges::lower_bound(pairs_, bodies, {}, &GapPair::bodies);
    return found != pairs_.end() && found->bodies == bodies ? &*found : nullptr;
}

/// The same pairs with the same contacts, between bodies that can be moved as before.
bool SolvedIslands::isAsBefore(const GapScratch& scratch, const GapIsland& island) const
{
    const GapPair* any = find(scratch.pairs[island.pairs.front()].bodies);
    if (!any || pairsOfIsland_[any->island] != island.pairs.size()) return false;
    return std::ranges::all_of(island.pairs, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        if (scratch.nearPairs[pair.near].wasAsked) return false;
        const auto [a, b] = pair.bodies;
        const auto isMovableAsBefore = [&](BodyId body) {
            return (scratch.bodies[body].inverseMass > 0.0) == (bodies_[body].inverseMass > 0.0);
        };
        if (!isMovableAsBefore(a) || !isMovableAsBefore(b)) return false;
        const GapPair* before = find(pair.bodies);
        return before && before->island == any->island;
    });
}

void SolvedIslands::handOn(GapScratch& scratch) const
{
    constexpr std::size_t kGone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> rowNow(rows_.size(), kGone);
    for (GapIsland& island : scratch.islands) {
        island.isKept = isAsBefore(scratch, island);
        if (!island.isKept) continue;
        for (const std::size_t i : island.pairs) {
            GapPair& pair = scratch.pairs[i];
            const GapPair& before = *find(pair.bodies);
            pair.fallsOnB = before.fallsOnB;
            pair.fallsOnA = before.fallsOnA;
            for (std::size_t r = pair.begin; r < pair.end; ++r) {
                const std::size_t then = before.begin + (r - pair.begin);
                rowNow[then] = r;
                const RowSolution& solved = rows_[then];
                GapRow& row = scratch.rows[r];
                row.impulse = solved.impulse;
                row.couple = solved.couple;
                row.target = solved.target;
                row.wasHit = solved.wasHit;
            }
            for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
                if (scratch.bodies[body].inverseMass == 0.0) continue;
                scratch.bodies[body] = bodies_[body];
                scratch.bodies[body].isKept = true;
            }
        }
    }
    for (const GapImpact& blow : impacts_) {
        if (rowNow[blow.row] == kGone) continue;
        scratch.impacts.push_back(blow);
        scratch.impacts.back().row = rowNow[blow.row];
    }
}

}  // namespace scree
