// Contacts whose place runs round the rim of a body that wobbles: a coin that comes to rest, a
// plate, a hubcap. [A40; algorithm 14]
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// What the solver is to see more of a body's velocity than there is [m/s].
struct VelocityLead {
    BodyId body;
    Vec3 velocity;
};

/// Gives the bodies of a block that roll on one place of a rim velocities that are right where this
/// place will be half a step later: for contacts, before the forces.
std::vector<VelocityLead> leadPlaces(const World& world, double dt, const GapBlock& block,
                                     GapScratch& scratch);

/// The same where it was half a step earlier, of contacts that have carried: for blows, or each
/// would seem to strike.
std::vector<VelocityLead> trailPlaces(const World& world, const GapBlock& block,
                                      GapScratch& scratch);

void takeBack(const std::vector<VelocityLead>& leads, GapScratch& scratch);

}  // namespace scree
