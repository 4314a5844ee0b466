// What keyed bodies hold between them by friction.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Presses the rows of what keyed bodies squeeze, for friction alone: jaws that are closed a little
/// too far hold what is between them, although nothing closes any more and no impulse is due. The
/// rows must have been built. `dt` [s].
void gripSqueezed(const World& world, const StepSettings& settings, double dt,
                  const GapBlock& block, GapScratch& scratch);

}  // namespace scree
