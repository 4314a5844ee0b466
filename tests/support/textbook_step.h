// The textbook order of time stepping: velocity, position, then collision and contact where the
// bodies ended up. It exists only as the control of experiments E1 and E2, which it must fail:
// gravity enters before collisions are looked for, so a block at rest is taken for one that has
// just landed.
#pragma once

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree::test {

void textbookStep(World& world, const StepSettings& settings, double dt);

}  // namespace scree::test
