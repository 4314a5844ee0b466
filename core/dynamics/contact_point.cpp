#include "core/dynamics/contact_point.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/collision/moving_samples.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/rolling_friction.h"
#include "core/dynamics/step_view.h"
#include "core/geometry/surface_curvature.h"
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

ContactPoint placeAsIs(const World& world, const PairRecord& pair, const Touch& touch,
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
    contact.sample = touch.sample;
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

/// The touch, at the place of its body that is deepest in the configuration the impulse acts in.
Touch movedToDeepest(const PlacedPair& placed, const Touch& touch, const Vec3& worldNormal)
{
    const bool ownedByA = touch.sampleOnA;
    const Shape& sampled = ownedByA ? *placed.shapeA : *placed.shapeB;
    const Shape& field = ownedByA ? *placed.shapeB : *placed.shapeA;
    const Pose& worldFromSampled = ownedByA ? placed.worldFromA : placed.worldFromB;
    const Pose& worldFromField = ownedByA ? placed.worldFromB : placed.worldFromA;
    const FieldFromSamples pose = relativePose(worldFromField, worldFromSampled);
    Touch moved = touch;
    if (sampled.samplesMove) {
        moved.point = movingSample(sampled, field, pose, touch);
    } else {
        moved.point = slidSample(sampled, field, pose, touch,
                                 worldFromField.orientation.conjugate() * worldNormal);
    }
    return moved;
}

/// The finite body of a pair with the smaller volume.  [A50]
const Shape& finerShape(const World& world, const BodyPair& bodies)
{
    const Shape& a = world.shapeOf(bodies.a);
    const Shape& b = world.shapeOf(bodies.b);
    if (!world.mass[bodies.a].isMovable()) return b;
    if (!world.mass[bodies.b].isMovable()) return a;
    return a.unitMass.volume <= b.unitMass.volume ? a : b;
}

/// Sticking friction, and with it resistance to rolling and spinning.
RollingImpulse rollingAt(const World& world, const StepSettings& settings, const PairRecord& pair,
                         const ContactPoint& contact, const ContactFrames& frames,
                         const PairInertia& inertia, const Vec3& sticking)
{
    const bool ownedByA = contact.sampleBody == pair.bodies.a;
    const Mat3& ownS = ownedByA ? inertia.ownInverseA : inertia.ownInverseB;
    const Mat3& ownF = ownedByA ? inertia.ownInverseB : inertia.ownInverseA;
    const Vec3 spin = ownS * world.motion[contact.sampleBody].angularMomentum -
                      ownF * world.motion[contact.fieldBody].angularMomentum;
    double factor = 1.0;
    if (settings.curvatureScaling) {
        const Pose& poseS = ownedByA ? frames.geometry.worldFromA : frames.geometry.worldFromB;
        const Pose& poseF = ownedByA ? frames.geometry.worldFromB : frames.geometry.worldFromA;
        const auto curvatureOf = [&](BodyId body, const Pose& pose, const Vec3& r) {
            const Shape& shape = world.shapeOf(body);
            return rollingCurvature(meanCurvature(shape, pose.orientation.conjugate() * r), shape);
        };
        const double curvature = curvatureOf(contact.sampleBody, poseS, contact.rS) +
                                 curvatureOf(contact.fieldBody, poseF, contact.rF);
        factor = curvatureFactor(curvature, finerShape(world, pair.bodies));
    }
    return rollingImpulse(
        {ownedByA ? inertia.passA : inertia.passB, ownedByA ? inertia.passB : inertia.passA,
         contact.rS, contact.rF, contact.normal, contact.u, spin, sticking, pair.friction},
        pair.rolling, factor);
}

/// An impulse on the body that owns the sample, told as one between A and B.
ContactSeen seenAt(const PairRecord& pair, const ContactPoint& contact, const ContactFrames& frames,
                   const Vec3& impulse)
{
    const bool ownedByA = contact.sampleBody == pair.bodies.a;
    const Pose& poseS = ownedByA ? frames.geometry.worldFromA : frames.geometry.worldFromB;
    const double sign = ownedByA ? 1.0 : -1.0;
    return {pair.bodies.a, pair.bodies.b, poseS.position + contact.rS, sign * contact.normal,
            sign * impulse};
}

/// What an impulse between two movable bodies keeps, and the sizes of what was summed for it.
struct PairMomentum {
    Vec3 linear;   ///< [N s]
    Vec3 angular;  ///< about S's centre of mass [N m s]
    double linearTerms = 0.0, angularTerms = 0.0;
};

PairMomentum momentumOf(const BodyMotion& s, const BodyMotion& f, const Vec3& fFromS,
                        const PassInertia& ofS, const PassInertia& ofF)
{
    const Vec3 linearS = s.velocity / ofS.inverseMass, linearF = f.velocity / ofF.inverseMass;
    const Vec3 orbital = fFromS.cross(linearF);
    return {linearS + linearF, orbital + s.angularMomentum + f.angularMomentum,
            linearS.norm() + linearF.norm(),
            orbital.norm() + s.angularMomentum.norm() + f.angularMomentum.norm()};
}

/// The same but for rounding, which is largest where the two are far from the world's origin.
bool isKept(const PairMomentum& before, const PairMomentum& after)
{
    constexpr double kRounding = 1e-9;
    const double linear = kRounding * (before.linearTerms + after.linearTerms);
    const double angular = kRounding * (before.angularTerms + after.angularTerms);
    // What is no number is the step's business.
    return !((after.linear - before.linear).norm() > linear) &&
           !((after.angular - before.angular).norm() > angular);
}

}  // namespace

ContactPoint placeContact(const World& world, const PairRecord& pair, const Touch& touch,
                          const ContactFrames& frames, const Mat3& inverseInertiaA,
                          const Mat3& inverseInertiaB, const StepSettings& settings)
{
    const ContactPoint contact =
        placeAsIs(world, pair, touch, frames, inverseInertiaA, inverseInertiaB);
    const Shape& sampled = world.shapeOf(contact.sampleBody);
    const bool isRound = sampled.samplesMove || !sampled.smooth.isEmpty();
    if (!isRound || !settings.slideSmoothSamples) return contact;
    const Touch moved = movedToDeepest(frames.geometry, touch, contact.normal);
    return placeAsIs(world, pair, moved, frames, inverseInertiaA, inverseInertiaB);
}

double slowestApproach(const StepSettings& settings, double dt)
{
    return std::max(1e-10 * settings.gravity.norm() * dt, 1e-15);
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

void applyContact(World& world, const StepSettings& settings, PairRecord& pair,
                  const ContactPoint& contact, const ContactFrames& frames,
                  const PairInertia& inertia, double restitution, ImpulseCounts& counts)
{
    const bool ownedByA = contact.sampleBody == pair.bodies.a;
    const PassInertia& ofS = ownedByA ? inertia.passA : inertia.passB;
    const PassInertia& ofF = ownedByA ? inertia.passB : inertia.passA;
    const Mat3 k = collisionMatrix(ofS, contact.rS) + collisionMatrix(ofF, contact.rF);
    const ContactImpulse j = contactImpulse(k, contact.u, contact.normal, restitution,
                                            pair.friction, settings.frictionFallback);
    RollingImpulse applied{j.impulse};
    if (j.kind == FrictionCase::sticking && !pair.rolling.isNone()) {
        applied = rollingAt(world, settings, pair, contact, frames, inertia, j.impulse);
        ++(applied.isDropped ? counts.rollingDropped : counts.rolling);
    }
    BodyMotion &s = world.motion[contact.sampleBody], &f = world.motion[contact.fieldBody];
    const BodyMotion sBefore = s, fBefore = f;
    applyImpulse(s, ofS, contact.rS, applied.impulse);
    applyImpulse(f, ofF, contact.rF, -applied.impulse);
    applyCouple(s, ofS, applied.couple);
    applyCouple(f, ofF, -applied.couple);
    const Vec3 apart = frames.geometry.worldFromB.position - frames.geometry.worldFromA.position;
    const Vec3 fFromS = ownedByA ? apart : Vec3(-apart);
    SCREE_VALIDATE(!ofS.isMovable() || !ofF.isMovable() ||
                       isKept(momentumOf(sBefore, fBefore, fFromS, ofS, ofF),
                              momentumOf(s, f, fFromS, ofS, ofF)),
                   world.info[contact.sampleBody].name + " and " +
                       world.info[contact.fieldBody].name + ": an impulse changed their momentum");
    countImpulse(counts, j.kind);
    if (pair.isWatched)
        showImpulse(pair, contact.sample, ownedByA, seenAt(pair, contact, frames, applied.impulse));
}

bool applyDeepest(World& world, const StepSettings& settings, PairRecord& pair,
                  const ContactFrames& frames, const PairInertia& inertia, double restitution,
                  double dt, ImpulseCounts& counts)
{
    const double slowest = slowestApproach(settings, dt);
    while (const std::optional<Touch> touch = pair.proximity.next()) {
        const ContactPoint contact = placeContact(world, pair, *touch, frames, inertia.ownInverseA,
                                                  inertia.ownInverseB, settings);
        if (contact.u.dot(contact.normal) >= -slowest) continue;
        applyContact(world, settings, pair, contact, frames, inertia, restitution, counts);
        return true;
    }
    return false;
}

}  // namespace scree
