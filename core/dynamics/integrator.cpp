// Symbols: x centre of mass, q orientation, L angular momentum, w angular velocity, I inertia
// (world).
#include "core/dynamics/integrator.h"

#include "core/math/rotation.h"

namespace scree {

Pose predictPose(const BodyMotion& now, const BodyMass& mass, const Vec3& velocity,
                 const Vec3& angularMomentum, OrientationUpdate update, double dt)
{
    if (!mass.isMovable()) return now.worldFromBody();
    const Mat3 inverseInertia =
        inverseInertiaWorld(now.orientation.toRotationMatrix(), mass.inverseInertia);
    const Vec3 w = inverseInertia * angularMomentum;
    Vec3 turn = dt * w;
    if (update == OrientationUpdate::secondOrder) {
        // While the body turns, I turns with it and w changes although L does not: dw/dt =
        // −I⁻¹(w×L).
        turn -= 0.5 * dt * dt * (inverseInertia * w.cross(angularMomentum));
    }
    return {now.position + dt * velocity, rotated(now.orientation, turn)};
}

void addGravity(World& world, const StepSettings& settings, double dt)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (world.mass[b].isMovable()) world.motion[b].velocity += dt * settings.gravity;
    }
}

void advancePositions(World& world, const StepSettings& settings, double dt)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        BodyMotion& motion = world.motion[b];
        const Pose next = predictPose(motion, world.mass[b], motion.velocity,
                                      motion.angularMomentum, settings.orientation, dt);
        motion.position = next.position;
        motion.orientation = next.orientation;
    }
}

Vec3 angularVelocity(const BodyMotion& motion, const BodyMass& mass)
{
    return inverseInertiaWorld(motion.orientation.toRotationMatrix(), mass.inverseInertia) *
           motion.angularMomentum;
}

double kineticEnergy(const BodyMotion& motion, const BodyMass& mass)
{
    if (!mass.isMovable()) return 0.0;
    return 0.5 * motion.velocity.squaredNorm() / mass.inverseMass +
           0.5 * angularVelocity(motion, mass).dot(motion.angularMomentum);
}

}  // namespace scree
