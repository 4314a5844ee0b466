#include "core/dynamics/gaps/gap_kept.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace scree {
namespace {

/// Room for so many rows. It is the largest list there is: while it grows, neither the old one is
/// kept beside the new for nothing, nor is there room for twice as many.
void makeRoom(std::size_t count, std::size_t taken, std::vector<GapRow>& rows)
{
    if (count > rows.capacity()) {
        if (taken == 0) {
            rows.clear();
            rows.shrink_to_fit();
        }
        rows.reserve(count + count / 8);
    }
    rows.resize(count);
}

/// What this attempt is going to solve: islands, and all bodies but those that are kept.
void listOpen(GapScratch& scratch)
{
    scratch.openIslands.clear();
    scratch.openRowCount = 0;
    for (std::size_t i = 0; i < scratch.islands.size(); ++i) {
        if (scratch.islands[i].isKept) continue;
        scratch.openIslands.push_back(i);
        scratch.openRowCount += scratch.islands[i].rowCount;
    }
    scratch.isSolvedAnew.resize(scratch.bodies.size(), 0);
    for (std::size_t i = 0; i < scratch.bodies.size(); ++i) {
        const GapBody& body = scratch.bodies[i];
        if (body.isMovable() && !body.isKept) scratch.isSolvedAnew[i] = 1;
    }
}

}  // namespace

SolvedIslands::SolvedIslands(const GapScratch& scratch)
    : pairs_(scratch.pairs),
      islands_(scratch.islands),
      bodies_(scratch.bodies),
      impacts_(scratch.impacts)
{
}

/// Per pair what it was; null where it was not, or has other rows now. Both lists are sorted.
std::vector<const GapPair*> SolvedIslands::pairsBefore(const GapScratch& scratch) const
{
    std::vector<const GapPair*> before(scratch.pairs.size(), nullptr);
    auto old = pairs_.begin();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const GapPair& pair = scratch.pairs[i];
        while (old != pairs_.end() && old->bodies < pair.bodies) ++old;
        if (old == pairs_.end()) break;
        if (old->bodies == pair.bodies && old->rowCount() == pair.rowCount()) before[i] = &*old;
    }
    return before;
}

/// The same pairs with the same contacts, between bodies that can be moved as before. One that was
/// let pass and has turned out to meet has to be stopped.
bool SolvedIslands::isAsBefore(const GapScratch& scratch, const GapIsland& island,
                               const std::vector<const GapPair*>& before) const
{
    const GapPair* any = before[island.pairs.front()];
    if (!any || islands_[any->island].pairs.size() != island.pairs.size()) return false;
    const auto isMovableAsBefore = [&](BodyId body) {
        return scratch.bodies[body].isMovable() == bodies_[body].isMovable();
    };
    return std::ranges::all_of(island.pairs, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        const bool isDiverted = before[i] && before[i]->isLetPass &&
                                std::ranges::binary_search(scratch.unseen.diverted, pair.bodies);
        return before[i] && before[i]->island == any->island && !isDiverted &&
               scratch.nearPairs[pair.nearPair].soughtIn != scratch.attempt &&
               isMovableAsBefore(pair.bodies.a) && isMovableAsBefore(pair.bodies.b);
    });
}

/// Where they were, as far as they had any; of others behind those that are taken.
void SolvedIslands::placeRows(const std::vector<const GapPair*>& before, std::size_t taken,
                              GapScratch& scratch)
{
    std::size_t end = taken;
    for (std::size_t i = 0; i < before.size(); ++i) {
        GapPair& pair = scratch.pairs[i];
        const std::size_t count = pair.rowCount();
        pair.begin = before[i] ? before[i]->begin : end;
        pair.end = pair.begin + count;
        if (!before[i]) end += count;
    }
    makeRoom(end, taken, scratch.rows);
}

/// Those of pairs that are no more, or have other rows now.
void SolvedIslands::clearRowsOfOthers(const std::vector<const GapPair*>& before,
                                      GapScratch& scratch) const
{
    auto still = before.begin();
    for (const GapPair& pair : pairs_) {
        while (still != before.end() && (!*still || *still < &pair)) ++still;
        if (still != before.end() && *still == &pair) continue;
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            scratch.rows[r].impulse = Vec3::Zero();
            scratch.rows[r].couple = Vec3::Zero();
        }
    }
}

void SolvedIslands::handOn(GapScratch& scratch) const
{
    const std::vector<const GapPair*> before = pairsBefore(scratch);
    clearRowsOfOthers(before, scratch);
    placeRows(before, isNone() ? 0 : scratch.rows.size(), scratch);
    std::vector<std::size_t> now(pairs_.size());  // per pair that was, where it still is
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i]) now[before[i] - pairs_.data()] = i;
    }
    forEach(scratch.islands.size(), 1, [&](std::size_t n) {
        GapIsland& island = scratch.islands[n];
        island.isKept = isAsBefore(scratch, island, before);
        if (!island.isKept) return;
        std::ranges::transform(islands_[before[island.pairs.front()]->island].pairs,
                               island.pairs.begin(), [&](std::size_t i) { return now[i]; });
        for (const std::size_t i : island.pairs) {
            GapPair& pair = scratch.pairs[i];
            pair.part = before[i]->part;
            pair.isCarried = before[i]->isCarried;
            pair.isLetPass = before[i]->isLetPass;
            pair.fallOnB = before[i]->fallOnB;
            pair.fallOnA = before[i]->fallOnA;
            for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
                GapBody& still = scratch.bodies[body];
                if (!still.isMovable() || still.isKept) continue;
                still = bodies_[body];
                still.isKept = true;
            }
        }
    });
    listOpen(scratch);
    scratch.impacts.clear();
    for (const GapImpact& blow : impacts_) {
        const GapRow& row = scratch.rows[blow.row];
        if (scratch.bodies[row.a].isKept || scratch.bodies[row.b].isKept)
            scratch.impacts.push_back(blow);
    }
}

}  // namespace scree
