// Phases 3 and 4: contact sweeps up the levels, then shock propagation, which is one more sweep of
// the same work with finished levels made immovable. [GBF03 “Contact”, “Shock Propagation”],
// [A39–A48]
#pragma once

#include "core/dynamics/contact_graph.h"
#include "core/dynamics/scratch.h"

namespace scree {

/// Sweeps whose restitution rises from −1 + 1/n to 0, so that bodies slow down gradually and the
/// weight of a heap is felt all the way down.  [A41–A43]
PassTally resolveContacts(World& world, const ContactGraph& graph, const StepSettings& settings,
                          double dt, StepScratch& scratch);

/// One sweep upward with restitution 0; after each level its supported bodies cannot be moved any
/// more. [A45–A47]
PassTally propagateShock(World& world, const ContactGraph& graph, const StepSettings& settings,
                         double dt, StepScratch& scratch);

}  // namespace scree
