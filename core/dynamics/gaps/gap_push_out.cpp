// Steps leave a thousandth of a body or so; removing that at once shook stacks, and a fifth of it
// in a step is enough.
//
// What does not overlap may close until it does, no farther, and every level weighs half as much as
// the one it lies on: a push lifts what is above rather than pressing what is below, and soon goes
// through a heap. With the overlaps alone, and masses as they are, pushes went into neighbours and
// were handed on by halves: of 150 coins in a bowl they made as much overlap as they took, lifted
// the heap by a tenth of a millimetre in a frame, and it never lay still. Masses are free here,
// since nothing of this is momentum; but with eighths a row of fallen dominoes rose, each lifted
// farther by the lever of the one before.
#include "core/dynamics/gaps/gap_push_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "core/dynamics/gaps/gap_pairs.h"
#include "core/dynamics/gaps/gap_push_deep.h"
#include "core/dynamics/gaps/gap_pushes.h"
#include "core/dynamics/gaps/stillness.h"

namespace scree {
namespace {

/// Share of what overlaps that one step removes, and how exactly, if the rounds do. In a round all
/// rows are visited once, and those that push some times more: what is in nobody's way seldom gets
/// there. While a heap moves, the next step makes good what one round has left.
constexpr double kShare = 0.2, kEnough = 0.1;
constexpr int kRoundsToRest = 4, kMoreSweeps = 3;

/// What has gone nowhere for kLongAround is left alone by and by, after twice that up to this share
/// of what is thinner. What is wedged sinks as much as pushes lift it, and so it does go somewhere:
/// a chimney of a thousand bricks with a hole in its foot, half a millimetre in each other, crept
/// by a centimetre a second on 8 J of pushes a frame, and fell after 13 s. Left alone it sleeps
/// after five; with half the share it creeps on.
constexpr double kLeftAtLast = 4e-3;

/// Beyond so many levels all weigh the same, while numbers hold them.
constexpr int kMostLevels = 60;

/// Draws apart what the deep pass has left, island by island.
class ShallowPass {
public:
    ShallowPass(World& world, const DeepPass& deep, const GapScratch& scratch)
        : world_(world),
          deep_(deep),
          scratch_(scratch),
          bodies_(room().bodies),
          most_(room().most),
          units_(room().units)
    {
        bodies_.resize(scratch.bodies.size());
    }

    PushOutTally run()
    {
        units_.resize(scratch_.bodies.size());
        forEach(units_.size(), kShortWork, [&](std::size_t i) {
            units_[i] = unitsAround(world_, scratch_, static_cast<BodyId>(i));
        });
        most_.resize(scratch_.pairs.size());
        forPairs(scratch_, [&](std::size_t i) { most_[i] = mostExcess(scratch_.pairs[i]); });
        std::vector<std::size_t> islands(scratch_.islands.size());
        std::iota(islands.begin(), islands.end(), std::size_t{0});
        std::vector<PushOutTally> tallies(islands.size());
        forIslands(scratch_, islands, scratch_.rowCount,
                   [&](std::size_t i) { tallies[i] = push(scratch_.islands[i]); });
        PushOutTally tally;
        for (const PushOutTally& one : tallies) tally += one;
        return tally;
    }

private:
    /// The rows of either half of an island or those across the cut, as of gap_pairs.h.
    struct Part {
        std::vector<PushRow> rows;
        std::vector<std::size_t> pushing;  // indices into these
        std::vector<BodyId> bodies;        // that none of the parts before it has
        PushOutTally tally;
        double changed = 0.0;  // in the last sweep over all rows, at most [m]
    };

    /// Kept from step to step by the thread that steps, filled by all.
    struct Room {
        std::vector<PushedBody> bodies;  // between steps no row has any
        std::vector<double> most;        // per pair: how much deeper than it may stay it is [m]
        std::vector<double> units;       // per body: unitsAround
    };
    static Room& room()
    {
        thread_local Room kept;
        return kept;
    }

    PushOutTally push(const GapIsland& island)
    {
        double most = 0.0;
        for (const std::size_t i : island.pairs) most = std::max(most, most_[i]);
        if (most == 0.0) return {};
        thread_local std::vector<std::size_t> roomForPairs;
        thread_local std::array<Part, 3> kept;
        std::array<Part, 3>& parts = kept;  // of this thread, filled by two
        const PairParts pairs = partsOf(scratch_, island, roomForPairs);
        const auto forParts = [&](const auto& work) {
            forEach(2, pairs[1].empty() ? 2 : 1, [&](std::size_t half) { work(half); });
            work(2);
        };
        forParts([&](std::size_t part) { layOut(pairs[part], parts[part]); });
        const int rounds = isSettling(world_, scratch_, island) ? kRoundsToRest : 1;
        solve(rounds, kEnough * kShare * most, forParts, parts);
        forParts([&](std::size_t part) { displaceBodies(parts[part]); });
        PushOutTally tally;
        for (const Part& part : parts) tally += part.tally;
        return tally;
    }

    /// As a share of the smaller body.
    double leftAlone(BodyPair pair) const
    {
        const double longest = std::min(units_[pair.a], units_[pair.b]);
        const double share = std::clamp(longest / kLongAround - 1.0, 0.0, 1.0);
        if (share == 0.0) return kSlop;
        const double thinner = std::min(world_.shapeOf(pair.a).commonThickness,
                                        world_.shapeOf(pair.b).commonThickness);
        const double atLast = kLeftAtLast * thinner / smallerRadius(world_, pair.a, pair.b);
        return kSlop + share * std::max(atLast - kSlop, 0.0);
    }

    double excess(const GapRow& row, double left) const
    {
        const double gap = row.gap + shiftAt(row, scratch_.bodies[row.a], scratch_.bodies[row.b]);
        return excessOf(world_, row, gap, left);
    }

    double mostExcess(const GapPair& pair) const
    {
        double most = 0.0;
        if (deep_.isLookedAt(pair)) return most;
        const double left = leftAlone(pair.bodies);
        for (std::size_t r = pair.begin; r < pair.end; ++r)
            most = std::max(most, excess(scratch_.rows[r], left));
        return most;
    }

    void layOut(std::span<const std::size_t> pairs, Part& part)
    {
        part.rows.clear();
        part.bodies.clear();
        part.tally = {};
        for (std::size_t n = 0; n < pairs.size(); ++n) {
            if (n + kPairsAhead < pairs.size()) fetch(scratch_.pairs[pairs[n + kPairsAhead]]);
            const GapPair& pair = scratch_.pairs[pairs[n]];
            if (deep_.isLookedAt(pair)) continue;
            takeUpBodies(pair.bodies, part.bodies);
            const double left = leftAlone(pair.bodies);
            for (std::size_t r = pair.begin; r < pair.end; ++r) {
                const double deeper = excess(scratch_.rows[r], left);
                const double wanted = deeper > 0.0 ? kShare * deeper : deeper;
                part.rows.push_back(pushRow(scratch_.rows[r], wanted, bodies_));
                part.tally.pushes += deeper > 0.0;
            }
        }
    }

    void fetch(const GapPair& pair) const
    {
        fetchRows(world_, scratch_, pair);
        for (const BodyId id : {pair.bodies.a, pair.bodies.b})
            fetchLines(&bodies_[id], &bodies_[id] + 1);
    }

    void takeUpBodies(BodyPair pair, std::vector<BodyId>& taken)
    {
        for (const BodyId id : {pair.a, pair.b}) {
            const GapBody& body = scratch_.bodies[id];
            if (!body.isMovable() || bodies_[id].inverseMass > 0.0) continue;
            const int level = std::min(scratch_.levels.level[id], kMostLevels);
            takeUp(body, std::ldexp(1.0, level), bodies_[id]);
            taken.push_back(id);
        }
    }

    template <class ForParts>
    void solve(int rounds, double enough, const ForParts& forParts, std::array<Part, 3>& parts)
    {
        for (int round = 0; round < rounds; ++round) {
            forParts([&](std::size_t part) { sweepAll(parts[part]); });
            const double changed = std::max({parts[0].changed, parts[1].changed, parts[2].changed});
            if (changed <= enough) return;
            for (int n = 0; n < kMoreSweeps; ++n) {
                forParts([&](std::size_t part) {
                    sweep(parts[part].rows, parts[part].pushing, 0.0, bodies_);
                });
            }
        }
    }

    void sweepAll(Part& part)
    {
        part.changed = sweep(part.rows, 0.0, bodies_);
        part.pushing.clear();
        for (std::size_t i = 0; i < part.rows.size(); ++i) {
            if (part.rows[i].impulse > 0.0) part.pushing.push_back(i);
        }
    }

    void displaceBodies(Part& part)
    {
        for (const BodyId id : part.bodies) {
            if (bodies_[id].isPushed) part.tally.cut += displace(world_, id, bodies_[id]);
            bodies_[id] = {};
        }
    }

    World& world_;
    const DeepPass& deep_;
    const GapScratch& scratch_;
    std::vector<PushedBody>& bodies_;
    std::vector<double>& most_;
    std::vector<double>& units_;
};

}  // namespace

PushOutTally separateGaps(World& world, const StepSettings& settings, GapScratch& scratch)
{
    DeepPass deep(world, settings, scratch);
    PushOutTally tally = deep.run();
    tally += ShallowPass(world, deep, scratch).run();
    return tally;
}

WorstOverlap findWorstGap(const World& world, const GapScratch& scratch)
{
    // The first of equal ones counts, however many threads there are.
    constexpr std::size_t kTogether = 1024;
    const std::vector<NearPair>& pairs = scratch.nearPairs;
    std::vector<WorstOverlap> ofParts((pairs.size() + kTogether - 1) / kTogether);
    forEach(ofParts.size(), 1, [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kTogether, pairs.size());
        for (std::size_t i = part * kTogether; i < end; ++i)
            ofParts[part].include(world, pairs[i].bodies, pairs[i].depth);
    });
    WorstOverlap worst;
    for (const WorstOverlap& one : ofParts) worst.include(one);
    return worst;
}

}  // namespace scree
