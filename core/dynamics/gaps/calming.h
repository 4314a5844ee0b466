// What rocks in its place for long need not be let rock for good.  [algorithm 14]
//
// A ring that leans on two others and rocks loses next to nothing at each swing: nothing in a world
// of rigid bodies takes that energy, and one such ring keeps a whole heap awake. So it loses its
// motion by and by. What rocks wide, as a bowl on its round bottom, does so for longer first.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// At the end of a step: takes some of their motion from bodies that lie on others and rock in
/// their place, as stillness.h has noted at the ends of frames. What a script moves is not to be
/// calmed, nor what lies on it. `scratch` holds the rows of the step.
///
/// In every step, for what is taken at the ends of frames alone may be none: two shards of a vase
/// rocked by half a millimetre once in two frames, and were at rest whenever they were calmed.
void calmWhatRocks(World& world, double dt, const GapScratch& scratch);

}  // namespace scree
