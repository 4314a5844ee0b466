// Points on moving bodies: their velocity, the matrix K that says how an impulse there changes it,
// and the application of impulses.  [GBF03 “Collisions”], [A0, A29, A34]
//
// Symbols: r contact point minus centre of mass, K = δ/m + r*ᵀ I⁻¹ r*, u velocity of the point.
#pragma once

#include "core/math/rotation.h"
#include "core/scene/body.h"

namespace scree {

/// The inertia a pass works with: world axes. Without inverse mass the body cannot be moved in this
/// pass; the inverse inertia of a keyed one then only tells how it spins.
struct PassInertia {
    double inverseMass = 0.0;            ///< [1/kg]
    Mat3 inverseInertia = Mat3::Zero();  ///< world [1/(kg m²)]

    bool isMovable() const { return inverseMass > 0.0; }

    /// How impulses turn the body: not at all if it cannot be moved.
    Mat3 turningByImpulse() const { return isMovable() ? inverseInertia : Mat3(Mat3::Zero()); }
};

inline PassInertia passInertia(const BodyMass& mass, const Quat& orientation)
{
    if (mass.inverseInertia.isZero(0.0)) return {};
    return {mass.inverseMass,
            inverseInertiaWorld(orientation.toRotationMatrix(), mass.inverseInertia)};
}

/// The same for a pass or a pair that may not move the body.  [A45, A57]
inline PassInertia fixedIf(bool isFixed, PassInertia inertia)
{
    if (isFixed) inertia.inverseMass = 0.0;
    return inertia;
}

/// K of one body [1/kg]; zero for one that cannot be moved. That of a pair is the sum.
inline Mat3 collisionMatrix(const PassInertia& inertia, const Vec3& r)
{
    if (!inertia.isMovable()) return Mat3::Zero();
    const Mat3 rStar = skew(r);
    return inertia.inverseMass * Mat3::Identity() +
           rStar.transpose() * inertia.inverseInertia * rStar;
}

/// Of the point at r, world [m/s]. `inverseInertia` must be the body's own, even when a pass has
/// frozen it: freezing forbids change, not motion.
inline Vec3 pointVelocity(const BodyMotion& motion, const Mat3& inverseInertia, const Vec3& r)
{
    return motion.velocity + Vec3(inverseInertia * motion.angularMomentum).cross(r);
}

/// `impulse` [N s] at r. Does nothing to a body that cannot be moved.
inline void applyImpulse(BodyMotion& motion, const PassInertia& inertia, const Vec3& r,
                         const Vec3& impulse)
{
    if (!inertia.isMovable()) return;
    motion.velocity += inertia.inverseMass * impulse;
    motion.angularMomentum += r.cross(impulse);
}

/// A pure couple [N m s]; does nothing to a body that cannot be moved.
inline void applyCouple(BodyMotion& motion, const PassInertia& inertia, const Vec3& couple)
{
    if (inertia.isMovable()) motion.angularMomentum += couple;
}

}  // namespace scree
