// What a further attempt at a step of method `scree` leaves as the one before has solved it.
//
// A step is solved again when it shows that a sleeper must wake, or that a body runs into what it
// was not looked at for. In a large world that is so somewhere in every step, and all of it was
// solved twice: a hundred fields of rings took half as long again as a hundred times one. Islands
// share no movable body, so those in which nothing has changed stay, and their rows where they are:
// laying these out anew, in ten fields of a thousand, took longer than solving what had changed.
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

class SolvedIslands {
public:
    /// Before the first attempt.
    SolvedIslands() = default;

    /// Remembers an attempt that has been solved. Rows stay in the scratch.
    explicit SolvedIslands(const GapScratch& scratch);

    bool isNone() const { return bodies_.empty(); }

    /// Finds room for the rows of all pairs that have been laid out. Those islands that are as they
    /// were take over their order, bodies, rows and blows, and are kept: no pass of this attempt
    /// looks at them. Lists the others.
    void handOn(GapScratch& scratch) const;

private:
    std::vector<const GapPair*> pairsBefore(const GapScratch& scratch) const;
    bool isAsBefore(const GapScratch& scratch, const GapIsland& island,
                    const std::vector<const GapPair*>& before) const;
    static void placeRows(const std::vector<const GapPair*>& before, std::size_t taken,
                          GapScratch& scratch);
    void clearRowsOfOthers(const std::vector<const GapPair*>& before, GapScratch& scratch) const;

    std::vector<GapPair> pairs_;  // sorted by bodies
    std::vector<GapIsland> islands_;
    std::vector<GapBody> bodies_;
    std::vector<GapImpact> impacts_;
};

}  // namespace scree
