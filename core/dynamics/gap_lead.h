// Contacts whose place goes round on a body that wobbles: a coin that comes to rest, a plate, a
// hubcap. [A40; algorithm 14]
#pragma once

#include <vector>

#include "core/dynamics/gap_scratch.h"

namespace scree {

/// What the solver is to see more of a body's velocity than there is [m/s].
struct VelocityLead {
    BodyId body;
    Vec3 velocity;
};

/// Gives the bodies of a block velocities that are right at the places that their contacts will
/// have half a step later. After the blows, before the forces; to be taken back when the block is
/// solved.
std::vector<VelocityLead> leadPlaces(const World& world, double dt, const GapBlock& block,
                                     GapScratch& scratch);

void takeBack(const std::vector<VelocityLead>& leads, GapScratch& scratch);

}  // namespace scree
