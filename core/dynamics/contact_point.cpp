#include "core/dynamics/contact_point.h"

#include "core/geometry/surface_normal.h"

namespace scree {

ContactPoint placeContact(const World& world, const PairRecord& pair, const Touch& touch,
                          const Pose& poseA, const Pose& poseB, const Mat3& inverseInertiaA,
                          const Mat3& inverseInertiaB)
{
    const bool ownedByA = touch.sampleOnA;
    const Pose& poseS = ownedByA ? poseA : poseB;
    const Pose& poseF = ownedByA ? poseB : poseA;
    const Mat3& inverseInertiaS = ownedByA ? inverseInertiaA : inverseInertiaB;
    const Mat3& inverseInertiaF = ownedByA ? inverseInertiaB : inverseInertiaA;

    ContactPoint contact;
    contact.sampleBody = ownedByA ? pair.bodies.a : pair.bodies.b;
    contact.fieldBody = ownedByA ? pair.bodies.b : pair.bodies.a;
    contact.rS = poseS.orientation * touch.point;
    const Vec3 p = poseS.position + contact.rS;
    contact.rF = p - poseF.position;
    contact.u = pointVelocity(world.motion[contact.sampleBody], inverseInertiaS, contact.rS) -
                pointVelocity(world.motion[contact.fieldBody], inverseInertiaF, contact.rF);
    const Quat fieldFromWorld = poseF.orientation.conjugate();
    contact.normal =
        poseF.orientation * surfaceNormal(world.shapeOf(contact.fieldBody),
                                          fieldFromWorld * contact.rF, fieldFromWorld * contact.u);
    return contact;
}

}  // namespace scree
