// Optional last phase: first-order separation of what still overlaps. Changes positions and
// orientations only.  [GBF03 “Shock Propagation”, last paragraph], [A52]
#pragma once

#include "core/dynamics/contact_graph.h"
#include "core/dynamics/scratch.h"

namespace scree {

struct PushOutTally {
    std::int64_t pushes = 0;
    std::int64_t cut = 0;  ///< longer than half the inner thickness, or turning more than 0.1 rad

    PushOutTally& operator+=(const PushOutTally& other)
    {
        pushes += other.pushes;
        cut += other.cut;
        return *this;
    }
};

/// The share of a push that keeps a body within the limits of one push: half the inner thickness,
/// 0.1 rad.
double admissibleShare(const Shape& shape, const Vec3& shift, const Vec3& turn);

/// Pushes apart level by level, a growing fraction of the depth at a time; finished levels stay
/// put.
PushOutTally separateOverlaps(World& world, const ContactGraph& graph, const StepSettings& settings,
                              StepScratch& scratch);

/// The worst interference below 0 of the touching pairs where the bodies are now.
WorstOverlap findWorstOverlap(const World& world, StepScratch& scratch);

}  // namespace scree
