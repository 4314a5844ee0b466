// Visits of pairs, at once where they have no body in common, with the bits of one after the other.
// [A21]
#pragma once

#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/scratch.h"

namespace scree {

struct PairVisit {
    std::size_t pair;   ///< index into StepScratch::pairs
    int level = 0;      ///< of the contact graph
    int iteration = 0;  ///< of its level
};

/// Visits that share a movable body follow each other as they are listed.
WorkOrder orderOf(const World& world, const StepScratch& scratch,
                  const std::vector<PairVisit>& visits);

/// Calls work(visit, pair, tally) for all visits and answers the sum of the tallies. The work may
/// write only what belongs to its pair and to the movable bodies of it.
template <class Tally, class Work>
Tally visitPairs(const std::vector<PairVisit>& visits, const WorkOrder& order, StepScratch& scratch,
                 const Work& work)
{
    std::vector<Tally> tallies(visits.size());
    parallelInOrder(
        order, [&](std::size_t i) { work(visits[i], scratch.pairs[visits[i].pair], tallies[i]); });
    Tally sum;
    for (const Tally& tally : tallies) sum += tally;
    return sum;
}

/// What a pass did.
struct PassTally {
    ImpulseCounts impulses;
    std::int64_t loopsAtTheirCap = 0;

    PassTally& operator+=(const PassTally& other)
    {
        impulses += other.impulses;
        loopsAtTheirCap += other.loopsAtTheirCap;
        return *this;
    }
};

}  // namespace scree
