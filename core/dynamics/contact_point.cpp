#include "core/dynamics/contact_point.h"

#include "core/dynamics/friction.h"
#include "core/geometry/surface_normal.h"

namespace scree {

namespace {

/// The touch's point in the frame of the body whose field it entered.
Vec3 pointInField(const PlacedPair& placed, const Touch& touch)
{
    const Pose& worldFromSample = touch.sampleOnA ? placed.worldFromA : placed.worldFromB;
    const Pose& worldFromField = touch.sampleOnA ? placed.worldFromB : placed.worldFromA;
    const Vec3 offset = worldFromSample.position - worldFromField.position;
    return worldFromField.orientation.conjugate() *
           (offset + worldFromSample.orientation * touch.point);
}

}  // namespace

ContactPoint placeContact(const World& world, const PairRecord& pair, const Touch& touch,
                          const ContactFrames& frames, const Mat3& inverseInertiaA,
                          const Mat3& inverseInertiaB)
{
    const bool ownedByA = touch.sampleOnA;
    const Pose& poseS = ownedByA ? frames.geometry.worldFromA : frames.geometry.worldFromB;
    const Pose& poseF = ownedByA ? frames.geometry.worldFromB : frames.geometry.worldFromA;
    const Mat3& inverseInertiaS = ownedByA ? inverseInertiaA : inverseInertiaB;
    const Mat3& inverseInertiaF = ownedByA ? inverseInertiaB : inverseInertiaA;

    ContactPoint contact;
    contact.sampleBody = ownedByA ? pair.bodies.a : pair.bodies.b;
    contact.fieldBody = ownedByA ? pair.bodies.b : pair.bodies.a;
    contact.rS = poseS.orientation * touch.point;
    contact.rF = poseS.position - poseF.position + contact.rS;
    contact.u = pointVelocity(world.motion[contact.sampleBody], inverseInertiaS, contact.rS) -
                pointVelocity(world.motion[contact.fieldBody], inverseInertiaF, contact.rF);

    const Quat fieldFromWorld = poseF.orientation.conjugate();
    const Approach approach{fieldFromWorld * contact.rF, fieldFromWorld * contact.u,
                            pointInField(frames.now, touch), pointInField(frames.predicted, touch)};
    contact.normal = poseF.orientation * surfaceNormal(world.shapeOf(contact.fieldBody), approach);
    return contact;
}

double slowestApproach(const StepSettings& settings, double dt)
{
    return 1e-10 * settings.gravity.norm() * dt + 1e-15;
}

void updateApproach(const World& world, const PairRecord& pair, const PairInertia& inertia,
                    ContactPoint& contact)
{
    const bool ownedByA = contact.sampleBody == pair.bodies.a;
    const Mat3& inverseS = ownedByA ? inertia.ownInverseA : inertia.ownInverseB;
    const Mat3& inverseF = ownedByA ? inertia.ownInverseB : inertia.ownInverseA;
    contact.u = pointVelocity(world.motion[contact.sampleBody], inverseS, contact.rS) -
                pointVelocity(world.motion[contact.fieldBody], inverseF, contact.rF);
}

void applyContact(World& world, const StepSettings& settings, const PairRecord& pair,
                  const ContactPoint& contact, const PairInertia& inertia, double restitution,
                  ImpulseCounts& counts)
{
    const bool ownedByA = contact.sampleBody == pair.bodies.a;
    const PassInertia& ofS = ownedByA ? inertia.passA : inertia.passB;
    const PassInertia& ofF = ownedByA ? inertia.passB : inertia.passA;
    const Mat3 k = collisionMatrix(ofS, contact.rS) + collisionMatrix(ofF, contact.rF);
    const ContactImpulse j = contactImpulse(k, contact.u, contact.normal, restitution,
                                            pair.friction, settings.frictionFallback);
    applyImpulse(world.motion[contact.sampleBody], ofS, contact.rS, j.impulse);
    applyImpulse(world.motion[contact.fieldBody], ofF, contact.rF, -j.impulse);
    countImpulse(counts, j.kind);
}

bool applyDeepest(World& world, const StepSettings& settings, const PairRecord& pair,
                  const ContactFrames& frames, const PairInertia& inertia, double restitution,
                  double slowest, const std::vector<Touch>& deepestFirst, ImpulseCounts& counts)
{
    for (const Touch& touch : deepestFirst) {
        const ContactPoint contact =
            placeContact(world, pair, touch, frames, inertia.ownInverseA, inertia.ownInverseB);
        if (contact.u.dot(contact.normal) >= -slowest) continue;
        applyContact(world, settings, pair, contact, inertia, restitution, counts);
        return true;
    }
    return false;
}

}  // namespace scree
