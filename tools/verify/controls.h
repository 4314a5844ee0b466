// CONTROLS, no part of the method: steps that leave out or misplace what the paper is about. They
// exist to fail, so that the experiments are known to see something.
#pragma once

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree::verify {

/// The textbook order: velocity, position, then collision and contact where the bodies ended up.
/// Gravity enters before collisions are looked for, so a block at rest is taken for one that has
/// just landed.  [E1, E2]
void textbookStep(World& world, const StepSettings& settings, double dt);

/// The paper's order but for one exchange: gravity before collisions. What lies still bounces with
/// a step's worth of fall; bounces that friction tilts throw it about.  [E1, figure 3]
void gravityFirstStep(World& world, const StepSettings& settings, double dt);

}  // namespace scree::verify
