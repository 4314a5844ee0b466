// Gravity, constant forces and force fields: what step 3 adds to velocities and what predictions
// count with is one and the same, found once at the beginning of the step.  [A17 step 3, A20, A56]
#pragma once

#include <vector>

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// What acts on a body throughout a step.
struct AppliedForce {
    Vec3 acceleration = Vec3::Zero();  ///< gravity included [m/s²]
    Vec3 torque = Vec3::Zero();        ///< world axes [N m]
};

/// Of every body, for a step of dt from where the world stands; zero for those that cannot be
/// moved. Wind is drag, which is taken implicitly: a long step brings a feather to the speed of the
/// air and never past it.
void findForces(const World& world, const StepSettings& settings, double dt,
                std::vector<AppliedForce>& forces);

/// v += dt a, L += dt τ.
void addForces(World& world, const std::vector<AppliedForce>& forces, double dt);

/// Acceleration by a field [m/s²] of a body at x with velocity v; `airGrip` is ½ ρ A / m of the
/// body [1/m], which only wind asks for. `time` is that of the shot.
Vec3 fieldAcceleration(const ForceField& field, double time, const Vec3& x, const Vec3& v,
                       double airGrip, double dt);

}  // namespace scree
