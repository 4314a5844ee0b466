// What rocks in its place for long need not be let rock for good.  [algorithm 14]
//
// A ring that leans on two others and rocks loses next to nothing at each swing: nothing in a world
// of rigid bodies takes that energy, and one such ring keeps a whole heap awake. So it loses its
// motion by and by. What rocks wide, as a bowl on its round bottom, does so for longer first.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// At the end of a frame, when stillness.h has noted who stays: takes some of their motion from
/// bodies that lie on others and rock in their place. What a script moves is not to be calmed, nor
/// what lies on it. `scratch` holds the rows of the last step.
void calmWhatRocks(World& world, const GapScratch& scratch);

}  // namespace scree
