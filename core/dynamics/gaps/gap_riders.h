// What leaves a keyed body that has carried it.  [A54]
//
// Contacts see of a keyed body the mean velocity of the step, so that what it carries neither lags
// nor sinks. That mean is the velocity half a step ago, and what flies on has that of now: a lift
// that braked let go of what it carried half a step's braking too fast.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// When a step has been solved: what a keyed body has carried and no longer does, and what lay on
/// that, goes on from the moment in which the script began to fall behind it, with the velocity of
/// that moment. Where the script has a kink, with the one before it.
void letRidersGo(const World& world, double dt, GapScratch& scratch);

}  // namespace scree
