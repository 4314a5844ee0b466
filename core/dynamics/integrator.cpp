// Symbols: q orientation, L angular momentum, w angular velocity, I inertia
// (world); D inverse principal moments.
#include "core/dynamics/integrator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/rotation.h"

namespace scree {

namespace {

/// Turns about a body axis for dt with what its component of L turns it by.
Quat turnedAbout(int axis, double inverseMoment, const Quat& q, const Vec3& L, double dt)
{
    const double component = (q.conjugate() * L)[axis];
    return q * exponentialMap(dt * inverseMoment * component * Vec3::Unit(axis));
}

/// A body of which two moments are the same turns about L as a whole and about its third axis
/// within that, both steadily. What the two differ by is turned about the axis of one, half of it
/// before and half after. Every part keeps L where it is, and the way back is the way there: energy
/// wavers and does not drift, and symmetric bodies turn exactly, however fast.  [DLM97]
Quat turnedFreely(const Quat& q, const Vec3& D, const Vec3& L, double dt)
{
    const std::array<double, 3> unlike{std::abs(D[1] - D[2]), std::abs(D[2] - D[0]),
                                       std::abs(D[0] - D[1])};
    const int axis =
        static_cast<int>(std::min_element(unlike.begin(), unlike.end()) - unlike.begin());
    const int one = (axis + 1) % 3, other = (axis + 2) % 3;
    const double rest = D[other] - D[one];
    const Quat before = turnedAbout(other, rest, q, L, 0.5 * dt);
    const Quat within = turnedAbout(axis, D[axis] - D[one], before, L, dt);
    const Quat whole = exponentialMap(dt * D[one] * L) * within;
    return turnedAbout(other, rest, whole, L, 0.5 * dt).normalized();
}

/// Whether a script has just let go of a body.
bool isLetGo(const World& world, const BodyInfo& body)
{
    const Clock& clock = world.clock;
    return body.script && body.keyedFrom < body.keyedUntil && clock.frame > 0 &&
           clock.frame == body.keyedUntil && clock.subStep == 0 && clock.frameTimeDone == 0.0;
}

/// Gives a body the velocity of its script between two times after that of the world.
void takeVelocity(World& world, BodyId body, double from, double to)
{
    const ScriptedMotion motion = scriptedMotion(world, body, from, to);
    world.motion[body].velocity = motion.velocity;
    world.motion[body].angularMomentum =
        momentumOfSpin(world.motion[body], world.mass[body], motion.spin);
}

/// With the mean of its last step, what was swung round left 7 degrees off at one step a frame.
/// [A55]
void letGo(World& world, BodyId body)
{
    takeVelocity(world, body, -kJustBefore * world.frameDuration, 0.0);
}

}  // namespace

Pose predictPose(const BodyMotion& now, const BodyMass& mass, const Vec3& velocity,
                 const Vec3& angularMomentum, OrientationUpdate update, double dt)
{
    if (!mass.isMovable()) return now.worldFromBody();
    const Vec3 position = now.position + dt * velocity;
    if (update == OrientationUpdate::symplectic)
        return {position, turnedFreely(now.orientation, mass.inverseInertia, angularMomentum, dt)};
    const Mat3 inverseInertia =
        inverseInertiaWorld(now.orientation.toRotationMatrix(), mass.inverseInertia);
    const Vec3 w = inverseInertia * angularMomentum;
    Vec3 turn = dt * w;
    if (update == OrientationUpdate::secondOrder) {
        // While the body turns, I turns with it and w changes although L does not: dw/dt =
        // −I⁻¹(w×L).
        turn -= 0.5 * dt * dt * (inverseInertia * w.cross(angularMomentum));
    }
    return {position, rotated(now.orientation, turn)};
}

ScriptedMotion scriptedMotion(const World& world, BodyId body, double from, double to)
{
    const Pose before = world.scriptedPose(body, world.time(from));
    const Pose after = world.scriptedPose(body, world.time(to));
    const Quat turn = after.orientation * before.orientation.conjugate();
    const double time = to - from;
    return {before.position, (after.position - before.position) / time,
            rotationVector(turn) / time};
}

void setKeyedBodiesOff(World& world)
{
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.info[body].kind != BodyKind::keyed) continue;
        takeVelocity(world, body, 0.0, kJustBefore * world.frameDuration);
    }
}

void aimKeyedBodies(World& world, double dt)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (world.info[b].kind != BodyKind::keyed) {
            if (isLetGo(world, world.info[b])) letGo(world, static_cast<BodyId>(b));
            continue;
        }
        BodyMotion& motion = world.motion[b];
        const Pose next = world.scriptedPose(static_cast<BodyId>(b), world.time(dt));
        const Quat turn = next.orientation * motion.orientation.conjugate();
        motion.velocity = (next.position - motion.position) / dt;
        motion.angularMomentum = momentumOfSpin(motion, world.mass[b], rotationVector(turn) / dt);
    }
}

Pose poseAfter(const World& world, const StepSettings& settings, BodyId body, double dt)
{
    if (world.info[body].kind == BodyKind::keyed) {
        return world.scriptedPose(body, world.time(dt));
    }
    const BodyMotion& motion = world.motion[body];
    return predictPose(motion, world.mass[body], motion.velocity, motion.angularMomentum,
                       settings.orientation, dt);
}

void advancePositions(World& world, const StepSettings& settings, double dt)
{
    forEach(world.bodyCount(), kShortWork, [&](std::size_t b) {
        const auto body = static_cast<BodyId>(b);
        if (world.contactMemory.isAsleep(body)) return;
        BodyMotion& motion = world.motion[body];
        const Pose next = poseAfter(world, settings, body, dt);
        const BodyMass& mass = world.mass[body];
        const bool isKeyed = world.info[body].kind == BodyKind::keyed;
        const Vec3 w = isKeyed ? angularVelocity(motion, mass) : Vec3(Vec3::Zero());
        motion.position = next.position;
        motion.orientation = next.orientation;
        // What a script keeps while it turns a body is the spin, not the angular momentum.
        if (isKeyed) motion.angularMomentum = momentumOfSpin(motion, mass, w);
    });
}

Vec3 momentumOfSpin(const BodyMotion& motion, const BodyMass& mass, const Vec3& w)
{
    const Quat& q = motion.orientation;
    const Vec3 inBody = q.conjugate() * w;
    return q * Vec3(inBody.cwiseQuotient(mass.inverseInertia));
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
