// What a second attempt at a step of method `scree` leaves as the first has solved it.
//
// A step is solved again when it shows that a sleeper must wake, or that a body runs into what it
// was not looked at for. In a large world that is so somewhere in every step, and all of it was
// solved twice: a hundred fields of rings took half as long again as a hundred times one. Islands
// share no movable body, so those in which nothing has changed stay.
#pragma once

#include <vector>

#include "core/dynamics/gap_rows.h"

namespace scree {

class SolvedIslands {
public:
    /// Remembers an attempt that has been solved.
    explicit SolvedIslands(const GapScratch& scratch);

    /// Those islands of the rows that have been built anew which are as they were take over their
    /// bodies, impulses and blows, and are kept: no pass of this attempt looks at them.
    void handOn(GapScratch& scratch) const;

private:
    struct RowSolution {
        Vec3 impulse, couple;
        double target;
        bool wasHit;
    };
    const GapPair* find(BodyPair bodies) const;
    bool isAsBefore(const GapScratch& scratch, const GapIsland& island) const;

    std::vector<GapPair> pairs_;  // sorted by bodies
    std::vector<std::size_t> pairsOfIsland_;
    std::vector<RowSolution> rows_;
    std::vector<GapBody> bodies_;
    std::vector<GapImpact> impacts_;
};

}  // namespace scree
