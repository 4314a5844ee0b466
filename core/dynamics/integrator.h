// Motion without contact: the one function that says where a body will be, and what scripts do.
// [GBF03 “Time Integration”], [A18–A20]
#pragma once

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// Where the body is after dt with velocity v and angular momentum L. Collision, contact graph and
/// contact predict with it, and the position update is this very function: what contact has not
/// found cannot happen.  [A19, A20]
Pose predictPose(const BodyMotion& now, const BodyMass& mass, const Vec3& velocity,
                 const Vec3& angularMomentum, OrientationUpdate update, double dt);

/// How long before a moment the velocity of a script is taken just then, in frames.
inline constexpr double kJustBefore = 1e-4;

struct ScriptedMotion {
    Vec3 place, velocity, spin;  ///< [m], [m/s] there, [rad/s]

    Vec3 velocityAt(const Vec3& x) const { return velocity + spin.cross(x - place); }
};

/// How a script moves a body between two times, told from the beginning of this step: the mean,
/// about where the body is at first.
ScriptedMotion scriptedMotion(const World& world, BodyId body, double from, double to);

/// Gives keyed bodies the velocities with which their scripts go on from the world's time: no step
/// has aimed them yet when the first frame is kept.
void setKeyedBodiesOff(World& world);

/// Gives keyed bodies the velocities that take them where their scripts are after dt: differences
/// over the step, so that what they carry neither lags nor sinks. What its script lets go of in
/// this step gets the velocity it had there.  [A54]
void aimKeyedBodies(World& world, double dt);

/// Where the body is after dt with its present velocities: by predictPose, or on its script.
Pose poseAfter(const World& world, const StepSettings& settings, BodyId body, double dt);

/// x and q of every body by poseAfter.  [A17 step 5]
void advancePositions(World& world, const StepSettings& settings, double dt);

/// L = I ω of a body that can be turned, for ω [rad/s].
Vec3 momentumOfSpin(const BodyMotion& motion, const BodyMass& mass, const Vec3& w);

/// ω = I⁻¹ L [rad/s].
Vec3 angularVelocity(const BodyMotion& motion, const BodyMass& mass);

/// Of one body: ½ m v² + ½ ω·L [J]; 0 for one that cannot be moved.
double kineticEnergy(const BodyMotion& motion, const BodyMass& mass);

}  // namespace scree
