#include "core/dynamics/friction.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace scree {
namespace {

/// Below this share of NᵀKN the sliding formula divides by almost nothing: a jam.  [A32]
constexpr double kJam = 0.05;

/// Tangential speed below this share of the whole has no direction.  [A32]
constexpr double kNoSlip = 1e-12;

/// K⁻¹ b. A pivot lost to an extreme mass ratio is looked for once more after scaling by the trace.
std::optional<Vec3> solve(const Mat3& collisionMatrix, const Vec3& b)
{
    Eigen::LLT<Mat3> cholesky(collisionMatrix);
    double scale = 1.0;
    if (cholesky.info() != Eigen::Success) {
        scale = collisionMatrix.trace();
        cholesky.compute(collisionMatrix / scale);
        if (cholesky.info() != Eigen::Success) return std::nullopt;
    }
    const Vec3 x = cholesky.solve(b) / scale;
    if (!x.allFinite()) return std::nullopt;
    return x;
}

bool isInCone(const Vec3& impulse, const Vec3& n, double mu)
{
    const double normal = impulse.dot(n);
    return (impulse - normal * n).norm() <= mu * normal;
}

/// The largest share of sticking that the cone and the energy allow, between the frictionless
/// impulse (share 0) and the sticking one (share 1). Both, and so all between, restore the normal
/// velocity exactly.  [A33]
Vec3 blend(const Mat3& collisionMatrix, const Vec3& u, const Vec3& n, double mu,
           const Vec3& frictionless, const Vec3& sticking)
{
    const double frictionlessNormal = frictionless.dot(n);
    const double stickingNormal = sticking.dot(n);
    const double tangential = (sticking - stickingNormal * n).norm();
    const double outOfCone = tangential - mu * (stickingNormal - frictionlessNormal);
    double share = 1.0;
    if (outOfCone > 0.0) share = std::min(share, mu * frictionlessNormal / outOfCone);

    const Vec3 step = sticking - frictionless;
    const double w0 = workOf(frictionless, collisionMatrix, u);
    const double w1 = u.dot(step) + frictionless.dot(collisionMatrix * step);
    const double w2 = 0.5 * step.dot(collisionMatrix * step);
    if (w2 == 0.0) return frictionless;  // head-on they are the same, and neither's work is exact
    return frictionless + std::min(share, shareWithoutGain(w0, w1, w2)) * step;
}

}  // namespace

double workOf(const Vec3& impulse, const Mat3& collisionMatrix, const Vec3& u)
{
    return u.dot(impulse) + 0.5 * impulse.dot(collisionMatrix * impulse);
}

double shareWithoutGain(double w0, double w1, double w2)
{
    if (w0 + w1 + w2 <= 0.0) return 1.0;
    // Convex, so the larger root bounds the share: of its two equal forms the one without
    // cancellation.
    const double root = std::sqrt(std::max(0.0, w1 * w1 - 4.0 * w2 * w0));
    return std::clamp(w1 <= 0.0 ? (-w1 + root) / (2.0 * w2) : -2.0 * w0 / (w1 + root), 0.0, 1.0);
}

ContactImpulse contactImpulse(const Mat3& collisionMatrix, const Vec3& u, const Vec3& n, double e,
                              double mu, FrictionFallback fallback)
{
    const double un = u.dot(n);
    const Vec3 kn = collisionMatrix * n;
    const double nkn = n.dot(kn);
    const Vec3 frictionless = -(1.0 + e) * un / nkn * n;

    const std::optional<Vec3> sticking = solve(collisionMatrix, -e * un * n - u);
    if (sticking && isInCone(*sticking, n, mu) && workOf(*sticking, collisionMatrix, u) <= 0.0) {
        return {*sticking, FrictionCase::sticking};
    }

    const Vec3 ut = u - un * n;
    const double slip = ut.norm();
    if (slip > kNoSlip * u.norm()) {
        const Vec3 direction = n - mu / slip * ut;
        const double d = kn.dot(direction);
        const bool isPlain = fallback == FrictionFallback::plainKinetic;
        if (d > (isPlain ? 0.0 : kJam * nkn)) {
            const Vec3 sliding = -(1.0 + e) * un / d * direction;
            if (isPlain || workOf(sliding, collisionMatrix, u) <= 0.0) {
                return {sliding, FrictionCase::sliding};
            }
        }
    }
    if (!sticking || fallback == FrictionFallback::plainKinetic)
        return {frictionless, FrictionCase::fallback};
    return {blend(collisionMatrix, u, n, mu, frictionless, *sticking), FrictionCase::fallback};
}

void countImpulse(ImpulseCounts& counts, FrictionCase kind)
{
    counts.sticking += kind == FrictionCase::sticking;
    counts.sliding += kind == FrictionCase::sliding;
    counts.fallback += kind == FrictionCase::fallback;
}

}  // namespace scree
