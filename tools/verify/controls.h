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

}  // namespace scree::verify
