// What carries many times its own weight is solved as if it were heavier.  [algorithm 14.1]
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Those bodies of a block, from here to release().
class LadenBodies {
public:
    /// Makes them heavier, as much as GapBody::heavier says then. Rows must remember what they bore
    /// in the last step, and forces must have acted. `dt` [s].
    LadenBodies(double dt, const GapBlock& block, GapScratch& scratch);

    /// Gives them their masses back. What they have come to weigh stays noted: their impulses have
    /// moved them so much less.
    void release();

private:
    struct Laden {
        BodyId body;
        double inverseMass;
        Mat3 inverseInertia;
    };

    GapScratch& scratch_;
    std::vector<Laden> laden_;
};

}  // namespace scree
