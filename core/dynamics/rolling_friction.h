// Resistance to rolling and spinning at a contact that sticks. [GBF03 “Rolling and Spinning
// Friction”], [A49–A51]
//
// Symbols: K1 … K4 the blocks that turn an impulse j at p and a couple c about p into changes of
//          the relative velocity u and spin w there: Δu = K1 j + K2 c, Δw = K2ᵀ j + K4 c; C the
//          part of K4 that is left when the point must not slip; n unit normal, jn normal impulse.
#pragma once

#include "core/dynamics/impulse.h"
#include "core/geometry/shape.h"

namespace scree {

/// A contact that sticking friction holds, before the impulse is applied.
struct StickingContact {
    PassInertia inertiaS, inertiaF;  ///< of the pass, world axes
    Vec3 rS, rF;                     ///< contact point minus centre of mass [m]
    Vec3 normal;                     ///< from F to S
    Vec3 u;                          ///< velocity of S's point against F's [m/s]
    Vec3 spin;                       ///< angular velocity of S against F [rad/s]
    Vec3 impulse;                    ///< of sticking friction, on S [N s]
    double friction;                 ///< Coulomb coefficient [-]
};

/// What is applied to S; the opposite goes to F. The couple acts about the contact point.
struct RollingImpulse {
    Vec3 impulse = Vec3::Zero();  ///< [N s]
    Vec3 couple = Vec3::Zero();   ///< [N m s]
    bool isDropped = false;       ///< Coulomb's cone or the energy left no room for resistance
};

/// C: how a couple on S, and its opposite on F, changes their relative spin while friction and the
/// normal impulse hold the point where they touch [1/(kg m²)]. Zero where nothing can be moved.
Mat3 rollingResponse(const PassInertia& inertiaS, const Vec3& rS, const PassInertia& inertiaF,
                     const Vec3& rF);

/// The sticking impulse with as much resistance as the friction cone and the energy allow. Spin
/// about the normal and rolling across it only ever slow down; neither changes sign. `factor`
/// scales the resistance (curvatureFactor).
RollingImpulse rollingImpulse(const StickingContact& contact, const RollingFriction& resistance,
                              double factor);

/// The larger of each of the two coefficients.  [A27]
RollingFriction largerOf(const RollingFriction& a, const RollingFriction& b);

/// What a place of a shape adds to the curvature of a pair, of what its distance field measures
/// there [1/m]. Where something round meets the ground, as a barrel does with both its rims, a
/// field sees a sharp edge, the sharper the finer it is: barrels and coins were braked by a tenth
/// to a quarter of what a shot said. They bend as the ball that its lever arms are told for, or
/// less; capsules and balls just as that, of which the field of their facets sees nine tenths.
/// [A50]
double rollingCurvature(double measured, const Shape& shape);

/// How much more a pair resists than round bodies do: 1 for a sphere on a plane, more where the
/// surfaces fit together, less on edges; from 0.1 to 10. `curvature` is the sum of both mean
/// curvatures [1/m], `finer` the shape of the smaller movable body.  [A50]
double curvatureFactor(double curvature, const Shape& finer);

}  // namespace scree
