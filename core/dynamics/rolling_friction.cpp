#include "core/dynamics/rolling_friction.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace scree {
namespace {

constexpr int kMostHalvings = 6;      // of a resistance that leaves the friction cone  [A51]
constexpr double kLeastFactor = 0.1;  // [A50]
constexpr double kMostFactor = 10.0;

/// R₀, of a ball its radius [m].  [A50]
double roundRadius(const Shape& shape)
{
    return 3.0 * shape.unitMass.volume / shape.unitMass.area;
}

/// The four blocks of both bodies together.
struct Blocks {
    Mat3 k1, k2, k4;

    Blocks(const PassInertia& inertiaS, const Vec3& rS, const PassInertia& inertiaF, const Vec3& rF)
        : k1(collisionMatrix(inertiaS, rS) + collisionMatrix(inertiaF, rF)),
          k2(-skew(rS) * inertiaS.turningByImpulse() - skew(rF) * inertiaF.turningByImpulse()),
          k4(inertiaS.turningByImpulse() + inertiaF.turningByImpulse())
    {
    }

    /// K1⁻¹ K2: what holds the point while a couple acts. None where nothing can be moved.
    std::optional<Mat3> slip() const
    {
        const Eigen::LLT<Mat3> decomposed(k1);
        if (decomposed.info() != Eigen::Success) return {};
        return decomposed.solve(k2);
    }
};

/// Resistance about a unit axis, as loss of spin by normal impulse [1/(kg m)]. A lever arm b
/// stands for the couple b jn; what spin that couple takes away is up to the inertia it meets.
///
/// A49 writes this inertia as D + m R² for round bodies; axisᵀ C axis is the same there and right
/// for every other.
double lossPerImpulse(double raw, double leverArm, const Mat3& c, const Vec3& axis)
{
    return raw + leverArm * axis.dot(c * axis);
}

double slowed(double spin, double loss)
{
    return std::copysign(std::max(0.0, std::abs(spin) - loss), spin);
}

/// What resistance takes from `spin`: about the normal and across it, never more than there is.
Vec3 changeOfSpin(const Vec3& spin, const StickingContact& contact,
                  const RollingFriction& resistance, const Mat3& c, double factor)
{
    const Vec3& n = contact.normal;
    const double strength = factor * contact.impulse.dot(n);
    const double about = spin.dot(n);
    const Vec3 across = spin - about * n;
    const double rate = across.norm();
    const double spinning = lossPerImpulse(resistance.rawSpinning, resistance.spinning, c, n);
    const Vec3 change = (slowed(about, strength * spinning) - about) * n;
    if (rate == 0.0) return change;
    const Vec3 axis = across / rate;
    const double rolling = lossPerImpulse(resistance.rawRolling, resistance.rolling, c, axis);
    return change + (slowed(rate, strength * rolling) - rate) * axis;
}

bool isAdmissible(const Blocks& blocks, const StickingContact& contact,
                  const RollingImpulse& applied)
{
    const double normal = applied.impulse.dot(contact.normal);
    const double tangential = (applied.impulse - normal * contact.normal).norm();
    if (tangential > contact.friction * normal) return false;
    const Vec3 changeOfU = blocks.k1 * applied.impulse + blocks.k2 * applied.couple;
    const Vec3 changeOfW = blocks.k2.transpose() * applied.impulse + blocks.k4 * applied.couple;
    const double work = applied.impulse.dot(contact.u + 0.5 * changeOfU) +
                        applied.couple.dot(contact.spin + 0.5 * changeOfW);
    return work <= 0.0;
}

}  // namespace

Mat3 rollingResponse(const PassInertia& inertiaS, const Vec3& rS, const PassInertia& inertiaF,
                     const Vec3& rF)
{
    const Blocks blocks(inertiaS, rS, inertiaF, rF);
    const std::optional<Mat3> slip = blocks.slip();
    return slip ? Mat3(blocks.k4 - blocks.k2.transpose() * *slip) : Mat3::Zero();
}

RollingImpulse rollingImpulse(const StickingContact& contact, const RollingFriction& resistance,
                              double factor)
{
    const RollingImpulse sticking{contact.impulse, Vec3::Zero(), true};
    const Blocks blocks(contact.inertiaS, contact.rS, contact.inertiaF, contact.rF);
    const std::optional<Mat3> slip = blocks.slip();
    if (!slip) return sticking;
    const Mat3 c = blocks.k4 - blocks.k2.transpose() * *slip;
    const Eigen::LLT<Mat3> ofC(c);
    if (ofC.info() != Eigen::Success) return sticking;

    // Departs from A49, which slows the spin that the bodies had before the impulse: then a ball on
    // a slope could never begin to roll, however small the resistance. What sticking friction
    // leaves is slowed, so that no resistance is the limit of little resistance.
    const Vec3 spin = contact.spin + blocks.k2.transpose() * contact.impulse;
    Vec3 change = changeOfSpin(spin, contact, resistance, c, factor);
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
        const Vec3 couple = ofC.solve(change);
        const RollingImpulse applied{contact.impulse - *slip * couple, couple, false};
        if (isAdmissible(blocks, contact, applied)) return applied;
        change *= 0.5;
    }
    return sticking;
}

RollingFriction largerOf(const RollingFriction& a, const RollingFriction& b)
{
    return {std::max(a.rolling, b.rolling), std::max(a.spinning, b.spinning),
            std::max(a.rawRolling, b.rawRolling), std::max(a.rawSpinning, b.rawSpinning)};
}

double rollingCurvature(double measured, const Shape& shape)
{
    if (shape.showsAllTurns()) return measured;
    const double ofBall = 1.0 / roundRadius(shape);
    return shape.isCapsule() ? ofBall : std::min(measured, ofBall);
}

double curvatureFactor(double curvature, const Shape& finer)
{
    if (curvature <= 0.0) return kMostFactor;
    return std::clamp(1.0 / (curvature * roundRadius(finer)), kLeastFactor, kMostFactor);
}

}  // namespace scree
