// The impulse of one contact: Newton restitution along the normal, Coulomb friction across it.
// [GBF03 “Collisions”, “Static and Kinetic Friction”], [A29–A35]
//
// Symbols: K collision matrix of the pair (3×3), u relative velocity of A's point against B's,
//          n unit normal from B to A, e restitution, mu friction, j impulse on A (−j on B) [N s].
#pragma once

#include "core/diagnostics/step_report.h"
#include "core/dynamics/settings.h"
#include "core/math/types.h"

namespace scree {

/// What became of friction at an impulse; `fallback`: neither sticking nor sliding would do.
enum class FrictionCase { none, sticking, sliding, fallback };

struct ContactImpulse {
    Vec3 impulse = Vec3::Zero();  ///< on A [N s]
    FrictionCase kind = FrictionCase::none;
};

/// The impulse for an approaching contact (u·n < 0). K must be symmetric positive definite; e in
/// [−1, 1], mu ≥ 0. Afterwards u'·n = −e u·n, the impulse lies in the friction cone, never pulls
/// and never adds energy; the last only with the fallback that blends.
ContactImpulse contactImpulse(const Mat3& collisionMatrix, const Vec3& u, const Vec3& n, double e,
                              double mu, FrictionFallback fallback = FrictionFallback::blend);

/// Change of kinetic energy by impulse j: u·j + ½ jᵀKj [J].
double workOf(const Vec3& impulse, const Mat3& collisionMatrix, const Vec3& u);

/// The largest share in 0 … 1 of a way along which kinetic energy changes by w0 + w1 s + w2 s²,
/// where it has not grown yet: w0 ≤ 0 at its beginning and w2 ≥ 0, energy being quadratic in
/// impulses.
double shareWithoutGain(double w0, double w1, double w2);

/// Adds one impulse of this kind to the counts.
void countImpulse(ImpulseCounts& counts, FrictionCase kind);

}  // namespace scree
