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

/// The method's step whose collision phase finds pairs as usual but whose impulses are taken back.
/// (The setting collision_iterations = 0 still runs the last pass, which is the one that finds
/// them.)  [E4]
void stepWithoutCollisions(World& world, const StepSettings& settings, double dt);

}  // namespace scree::verify
