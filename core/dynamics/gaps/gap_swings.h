// What swings on what it hangs from, and what rides on something that turns: within a step both
// leave the straight way on which their velocities take them.  [algorithm 14.1]
#pragma once

#include <span>

#include "core/dynamics/gaps/gap_lead.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Lets the rows of all that is no heap know where their places will be, going round or running
/// over what is round: by their targets, which must be those of straight ways, by GapRow::turning
/// and GapRow::swings. Bodies with `leads` know it already.
void holdSwings(const World& world, double dt, std::span<const VelocityLead> leads,
                const GapBlock& block, GapScratch& scratch);

/// Whether a row that does not swing will in the next step, by what this one, once solved, has
/// turned its bodies.
bool beginsToSwing(const World& world, const GapScratch& scratch, const GapRow& row);

}  // namespace scree
