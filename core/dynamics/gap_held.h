// What carried the bodies of method `scree` in the last step, and will again if nothing happens.
#pragma once

#include <vector>

#include "core/dynamics/gap_scratch.h"

namespace scree {

/// What accelerates a body beside what pulls it.
struct Held {
    Vec3 acceleration = Vec3::Zero(), turning = Vec3::Zero();  ///< [m/s²], [rad/s²]
};

/// Per place of a body in the block, if all that carried it in the last step does so again: rows
/// begin with the impulses that are remembered.
std::vector<Held> heldAsBefore(double dt, const GapBlock& block, const GapScratch& scratch);

}  // namespace scree
