#include "core/dynamics/gaps/gap_pairs.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_forces.h"

namespace scree {
namespace {

/// A keyed body beside a sleeping one moves nothing, nor does one that the sleeper's group does not
/// move.
bool movesSomething(const World& world, const GapScratch& scratch, BodyPair bodies)
{
    const auto isMovedBy = [&](BodyId body, BodyId other) {
        return scratch.bodies[body].isMovable() && !isUnmovedBy(world, body, other);
    };
    return isMovedBy(bodies.a, bodies.b) || isMovedBy(bodies.b, bodies.a);
}

void collectPairs(const World& world, GapScratch& scratch)
{
    scratch.pairs.clear();
    scratch.rowCount = 0;
    for (std::size_t i = 0; i < scratch.nearPairs.size(); ++i) {
        NearPair& near = scratch.nearPairs[i];
        if (near.contacts.empty()) continue;
        if (!movesSomething(world, scratch, near.bodies)) {
            near.contacts.clear();
            near.foundWithin = -1.0;
            near.depth = 0.0;
            continue;
        }
        scratch.pairs.push_back(
            {.bodies = near.bodies, .nearPair = i, .end = near.contacts.size()});
        scratch.rowCount += near.contacts.size();
    }
}

/// Two halves at once.
template <class Item, class Before>
void sortInHalves(std::vector<Item>& items, const Before& before)
{
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    forEach(2, 1, [&](std::size_t half) {
        std::sort(half == 0 ? items.begin() : middle, half == 0 ? middle : items.end(), before);
    });
    std::inplace_merge(items.begin(), middle, items.end(), before);
}

void listMovers(const GapScratch& scratch, GapIsland& island)
{
    // A body has several pairs: sorting them all took longer than what the list was for.
    thread_local std::vector<char> isListed;
    isListed.resize(std::max(isListed.size(), scratch.bodies.size()));
    std::vector<BodyId>& movers = island.movers;
    movers.clear();
    for (const std::size_t i : island.pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
            if (isListed[body] || !scratch.bodies[body].isMovable()) continue;
            isListed[body] = true;
            movers.push_back(body);
        }
    }
    for (const BodyId mover : movers) isListed[mover] = false;
    std::sort(movers.begin(), movers.end());
}

/// In the order of the first of their pairs.
void cutIntoIslands(GapScratch& scratch)
{
    thread_local std::vector<std::size_t> all;
    thread_local Groups together;
    all.resize(scratch.pairs.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    groupByBodies(scratch, all, together);
    scratch.islands.resize(together.size());
    for (std::size_t n = 0; n < together.size(); ++n) {
        GapIsland& island = scratch.islands[n];
        island.pairs.assign(together[n].begin(), together[n].end());
        island.rowCount = 0;
        island.isRemembered = island.isKept = false;
        for (const std::size_t i : island.pairs) {
            GapPair& pair = scratch.pairs[i];
            pair.island = n;
            island.rowCount += pair.rowCount();
        }
    }
    forEach(scratch.islands.size(), 1,
            [&](std::size_t n) { listMovers(scratch, scratch.islands[n]); });
}

/// Bottom to top: what carries is solved before what is carried.
void orderByHeight(const World& world, GapScratch& scratch)
{
    std::vector<Vec3> down(scratch.islands.size());
    forIslands(scratch, scratch.openIslands, scratch.openRowCount,
               [&](std::size_t i) { down[i] = meanPull(scratch, scratch.islands[i]); });
    std::vector<double> heights(scratch.pairs.size());
    forEach(heights.size(), kShortWork, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        if (scratch.islands[pair.island].isKept) return;
        fetchContactsAfter(scratch, i);
        const Vec3& centreOfA = world.motion[pair.bodies.a].position;
        heights[i] = -down[pair.island].dot(centreOfA + scratch.contactsOf(pair).front().rA);
    });
    forIslands(scratch, scratch.openIslands, scratch.openRowCount, [&](std::size_t i) {
        sortInHalves(scratch.islands[i].pairs, [&](std::size_t p, std::size_t q) {
            return std::pair(heights[p], p) < std::pair(heights[q], q);
        });
    });
}

/// Cuts an island where its bodies spread most, across gravity or not.
void cutInTwo(const GapIsland& island, GapScratch& scratch)
{
    const auto isMovable = [&](BodyId body) { return scratch.bodies[body].isMovable(); };
    const auto place = [&](BodyId body) -> const Vec3& { return scratch.seenAt[body].position; };
    std::vector<BodyId> bodies;
    bodies.reserve(2 * island.pairs.size());
    Aabb box;
    for (const std::size_t i : island.pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
            if (!isMovable(body)) continue;
            bodies.push_back(body);
            box.include(place(body));
        }
    }
    Eigen::Index axis;
    (box.max - box.min).maxCoeff(&axis);
    const auto middle = bodies.begin() + static_cast<std::ptrdiff_t>(bodies.size() / 2);
    std::nth_element(bodies.begin(), middle, bodies.end(),
                     [&](BodyId p, BodyId q) { return place(p)[axis] < place(q)[axis]; });
    const double cut = place(*middle)[axis];
    for (const std::size_t i : island.pairs) {
        const auto [a, b] = scratch.pairs[i].bodies;
        const auto half = [&](BodyId body) { return place(body)[axis] < cut ? 0 : 1; };
        const int ofA = half(isMovable(a) ? a : b), ofB = half(isMovable(b) ? b : a);
        scratch.pairs[i].part = ofA == ofB ? ofA : 2;
    }
}

void cutLargeIslands(GapScratch& scratch)
{
    const std::vector<std::size_t>& islands = scratch.openIslands;
    forEach(islands.size(), 1, [&](std::size_t n) {
        const GapIsland& island = scratch.islands[islands[n]];
        if (island.rowCount >= kRowsWorthACut) cutInTwo(island, scratch);
    });
}

}  // namespace

void layPairs(const World& world, GapScratch& scratch)
{
    collectPairs(world, scratch);
    cutIntoIslands(scratch);
}

void orderPairs(const World& world, GapScratch& scratch)
{
    orderByHeight(world, scratch);
    cutLargeIslands(scratch);
    // What one island needs is in the cache until it is done with.
    scratch.order.clear();
    for (const GapIsland& island : scratch.islands)
        scratch.order.insert(scratch.order.end(), island.pairs.begin(), island.pairs.end());
}

void groupByBodies(const GapScratch& scratch, std::span<const std::size_t> pairs, Groups& together)
{
    const auto isMovable = [&](BodyId body) { return scratch.bodies[body].isMovable(); };
    // Few bodies of a large world may be in these pairs: what is done for each is done for those.
    thread_local std::vector<std::int32_t> placeOf;
    thread_local std::vector<BodyId> met;
    placeOf.resize(scratch.bodies.size(), -1);
    met.clear();
    for (const std::size_t i : pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
            if (!isMovable(body) || placeOf[body] >= 0) continue;
            placeOf[body] = static_cast<std::int32_t>(met.size());
            met.push_back(body);
        }
    }
    thread_local DisjointSets sets;
    sets.begin(met.size());
    for (const std::size_t i : pairs) {
        const auto [a, b] = scratch.pairs[i].bodies;
        if (isMovable(a) && isMovable(b)) sets.join(placeOf[a], placeOf[b]);
    }

    // Number the sets as they are met, and sort by these numbers.
    constexpr std::size_t kNone = ~std::size_t{0};
    thread_local std::vector<std::size_t> groupOf;  // of the lowest of a set
    groupOf.assign(met.size(), kNone);
    std::size_t count = 0;
    const auto lowestOf = [&](std::size_t i) {
        const auto [a, b] = scratch.pairs[i].bodies;
        return isMovable(a) || isMovable(b) ? sets.find(placeOf[isMovable(a) ? a : b]) : kNone;
    };
    for (const std::size_t i : pairs) {
        const std::size_t lowest = lowestOf(i);
        if (lowest != kNone && groupOf[lowest] == kNone) groupOf[lowest] = count++;
    }
    together.sort(pairs, count, [&](std::size_t i) {
        const std::size_t lowest = lowestOf(i);
        return lowest == kNone ? count : groupOf[lowest];
    });
    for (const BodyId body : met) placeOf[body] = -1;
}

PairParts partsOf(const GapScratch& scratch, const GapIsland& island,
                  std::vector<std::size_t>& room)
{
    if (island.rowCount < kRowsWorthACut) return {island.pairs};
    room.clear();
    room.reserve(island.pairs.size());
    std::array<std::size_t, 4> begin{};
    for (int part = 0; part < 3; ++part) {
        std::ranges::copy_if(island.pairs, std::back_inserter(room),
                             [&](std::size_t i) { return scratch.pairs[i].part == part; });
        begin[part + 1] = room.size();
    }
    const std::span<const std::size_t> all = room;
    return {all.subspan(begin[0], begin[1] - begin[0]), all.subspan(begin[1], begin[2] - begin[1]),
            all.subspan(begin[2])};
}

}  // namespace scree
