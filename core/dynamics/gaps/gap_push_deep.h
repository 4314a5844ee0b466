// What is deep is drawn apart at once and the paper's way: gradually, and bottom to top, so that a
// column rises from the floor and nothing is pressed into what is already right.  [A52; algorithm
// 14.1]
//
// Steps leave a thousandth of a body or so. What is deeper has begun so, or is squeezed by a
// script: a fifth a step would show it coming apart for a second.
#pragma once

#include <span>
#include <vector>

#include "core/dynamics/gaps/gap_pushes.h"
#include "core/dynamics/push_limits.h"

namespace scree {

class DeepPass {
public:
    DeepPass(World& world, const StepSettings& settings, GapScratch& scratch);

    PushOutTally run();

    /// Whether the rows of a pair have been dealt with.
    bool isLookedAt(const GapPair& pair) const
    {
        return !isLookedAt_.empty() && isLookedAt_[pair.nearPair] != 0;
    }

private:
    struct RowToPush {
        GapRow row;
        double left;  // for the steps to remove, as a share of the smaller body
    };

    std::vector<std::vector<std::size_t>> pairsByLevel() const;
    bool isDeep(BodyPair pair, double depth) const;
    void findDeepPairs();
    bool pushRound(const std::vector<std::vector<std::size_t>>& levels, double fraction);
    void pushLevel(const std::vector<std::size_t>& level, double fraction);
    void addRows(std::size_t i);
    bool isFrozen(BodyId body, int level) const;
    double look(NearPair& pair, double reach);
    double depthShare(const NearPair& pair) const;
    bool holdBack(std::span<const BodyId> bodies);
    bool displaceAll();
    double lookAgain();

    World& world_;
    const StepSettings& settings_;
    GapScratch& scratch_;
    PushOutTally tally_;
    double reach_ = 0.0;  // of contacts that pushes may close: the deepest overlap [m]
    // Most steps find nothing deep, and then these are empty.
    std::vector<char> isLookedAt_, isPushed_;  // per near pair; per body
    std::vector<double> left_;                 // per near pair: as of RowToPush
    std::vector<GapContact> contacts_;
    std::vector<RowToPush> rows_;
    std::vector<PushRow> pushes_;
    std::vector<PushedBody> bodies_;
};

}  // namespace scree
