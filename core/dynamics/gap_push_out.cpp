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
#include "core/dynamics/gap_push_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/dynamics/gap_pairs.h"
#include "core/dynamics/gap_push_deep.h"
#include "core/dynamics/gap_pushes.h"
#include "core/dynamics/stillness.h"

namespace scree {
namespace {

/// Share of what overlaps that one step removes, and how exactly, if the rounds do. In a round all
/// rows are visited once, and those that push some times more: what is in nobody's way seldom gets
/// there. While a heap moves, the next step makes good what one round has left.
constexpr double kShare = 0.2, kEnough = 0.1;
constexpr int kRoundsToRest = 4, kMoreSweeps = 3;

/// Beyond so many levels all weigh the same, while numbers hold them.
constexpr int kMostLevels = 60;

/// Draws apart what the deep pass has left, island by island.
class ShallowPass {
public:
    ShallowPass(World& world, const DeepPass& deep, const GapScratch& scratch)
        : world_(world), deep_(deep), scratch_(scratch), bodies_(roomForBodies())
    {
        bodies_.resize(scratch.bodies.size());
    }

    PushOutTally run()
    {
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
    /// The rows of either half of an island and those across the cut, as of gap_pairs.h.
    struct Parts {
        std::vector<std::size_t> pairs;
        std::array<std::vector<PushRow>, 3> rows;
        std::array<std::vector<std::size_t>, 3> pushing;  // indices into these
        std::vector<BodyId> bodies;
    };

    /// Kept from step to step by the thread that steps, filled by all. Between steps no row has
    /// any.
    static std::vector<PushedBody>& roomForBodies()
    {
        thread_local std::vector<PushedBody> bodies;
        return bodies;
    }

    PushOutTally push(const GapIsland& island)
    {
        const double most = mostExcess(island);
        if (!(most > 0.0)) return {};
        thread_local Parts kept;
        Parts& parts = kept;  // of this thread, filled by two
        PushOutTally tally = layOut(island, parts);
        const int rounds = isSettling(world_, scratch_, island) ? kRoundsToRest : 1;
        solve(kEnough * kShare * most, rounds, parts);
        for (const BodyId id : parts.bodies) {
            if (bodies_[id].isPushed) tally.cut += displace(world_, id, bodies_[id]);
            bodies_[id] = {};
        }
        return tally;
    }

    double excess(const GapRow& row) const
    {
        const double gap = row.gap + shiftAt(row, scratch_.bodies[row.a], scratch_.bodies[row.b]);
        return excessOf(world_, row, gap);
    }

    double mostExcess(const GapIsland& island) const
    {
        double most = 0.0;
        for (const std::size_t i : island.pairs) {
            const GapPair& pair = scratch_.pairs[i];
            if (deep_.isLookedAt(pair)) continue;
            for (std::size_t r = pair.begin; r < pair.end; ++r)
                most = std::max(most, excess(scratch_.rows[r]));
        }
        return most;
    }

    PushOutTally layOut(const GapIsland& island, Parts& parts)
    {
        PushOutTally tally;
        parts.bodies.clear();
        const PairParts pairs = partsOf(scratch_, island, parts.pairs);
        for (std::size_t part = 0; part < pairs.size(); ++part) {
            std::vector<PushRow>& rows = parts.rows[part];
            rows.clear();
            for (const std::size_t i : pairs[part]) {
                const GapPair& pair = scratch_.pairs[i];
                if (deep_.isLookedAt(pair)) continue;
                takeUpBodies(pair.bodies, parts.bodies);
                for (std::size_t r = pair.begin; r < pair.end; ++r) {
                    const double deeper = excess(scratch_.rows[r]);
                    const double wanted = deeper > 0.0 ? kShare * deeper : deeper;
                    rows.push_back(pushRow(scratch_.rows[r], wanted, bodies_));
                    tally.pushes += deeper > 0.0;
                }
            }
        }
        return tally;
    }

    void takeUpBodies(BodyPair pair, std::vector<BodyId>& taken)
    {
        for (const BodyId id : {pair.a, pair.b}) {
            const GapBody& body = scratch_.bodies[id];
            if (body.inverseMass == 0.0 || bodies_[id].inverseMass > 0.0) continue;
            const int level = std::min(scratch_.levels.level[id], kMostLevels);
            takeUp(body, std::ldexp(1.0, level), bodies_[id]);
            taken.push_back(id);
        }
    }

    void solve(double enough, int rounds, Parts& parts)
    {
        std::array<double, 3> changed{};
        const auto sweepParts = [&](const auto& sweepPart) {
            forEach(2, parts.rows[1].empty() ? 2 : 1, sweepPart);
            sweepPart(2);
        };
        for (int round = 0; round < rounds; ++round) {
            sweepParts([&](std::size_t part) {
                changed[part] = sweep(parts.rows[part], 0.0, bodies_);
                listPushing(parts.rows[part], parts.pushing[part]);
            });
            if (*std::ranges::max_element(changed) <= enough) return;
            for (int n = 0; n < kMoreSweeps; ++n) {
                sweepParts([&](std::size_t part) {
                    sweep(parts.rows[part], parts.pushing[part], 0.0, bodies_);
                });
            }
        }
    }

    static void listPushing(const std::vector<PushRow>& rows, std::vector<std::size_t>& pushing)
    {
        pushing.clear();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].impulse > 0.0) pushing.push_back(i);
        }
    }

    World& world_;
    const DeepPass& deep_;
    const GapScratch& scratch_;
    std::vector<PushedBody>& bodies_;
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
