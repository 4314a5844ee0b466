#include "core/dynamics/contact_point.h"

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

}  // namespace scree
