#include "core/math/rotation.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace scree {
namespace {

// Taylor polynomials on |y| ≤ π/4: the first term left out is below 1e-19.
double sineKernel(double y)
{
    const double z = y * y;
    double sum = 1.0 / 355687428096000.0;  // 17!
    sum = -1.0 / 1307674368000.0 + z * sum;
    sum = 1.0 / 6227020800.0 + z * sum;
    sum = -1.0 / 39916800.0 + z * sum;
    sum = 1.0 / 362880.0 + z * sum;
    sum = -1.0 / 5040.0 + z * sum;
    sum = 1.0 / 120.0 + z * sum;
    sum = -1.0 / 6.0 + z * sum;
    return y + y * (z * sum);
}

double cosineKernel(double y)
{
    const double z = y * y;
    double sum = -1.0 / 6402373705728000.0;  // 18!
    sum = 1.0 / 20922789888000.0 + z * sum;
    sum = -1.0 / 87178291200.0 + z * sum;
    sum = 1.0 / 479001600.0 + z * sum;
    sum = -1.0 / 3628800.0 + z * sum;
    sum = 1.0 / 40320.0 + z * sum;
    sum = -1.0 / 720.0 + z * sum;
    sum = 1.0 / 24.0 + z * sum;
    return 1.0 - (0.5 * z - z * z * sum);
}

}  // namespace

void sinCos(double x, double& sine, double& cosine)
{
    // No number of quadrants: what is no number any more is found at the end of the step.
    if (!(std::abs(x) < 1e15)) {
        sine = cosine = std::numeric_limits<double>::quiet_NaN();
        return;
    }
    // π/2 in three pieces, the first two of 33 bits: their products with the quadrant number are
    // exact for |x| ≤ 1e6.
    constexpr double kHalfPi1 = 1.57079632673412561417;
    constexpr double kHalfPi2 = 6.07710050630396597660e-11;
    constexpr double kHalfPi3 = 2.02226624879595063154e-21;
    const double quadrant = std::floor(x * (2.0 / kPi) + 0.5);
    const double y = ((x - quadrant * kHalfPi1) - quadrant * kHalfPi2) - quadrant * kHalfPi3;
    const double s = sineKernel(y);
    const double c = cosineKernel(y);
    switch (static_cast<long long>(quadrant) & 3) {
        case 0:
            sine = s;
            cosine = c;
            break;
        case 1:
            sine = c;
            cosine = -s;
            break;
        case 2:
            sine = -s;
            cosine = -c;
            break;
        default:
            sine = -c;
            cosine = s;
            break;
    }
}

double arcTangent(double x)
{
    // Halve the angle twice, then the series converges fast: |y| ≤ tan(π/16) ≈ 0.199.
    double y = x;
    if (!(y < 1e300)) return kPi / 2.0;
    const bool large = y > 1.0;
    if (large) y = 1.0 / y;
    for (int i = 0; i < 2; ++i) y = y / (1.0 + std::sqrt(1.0 + y * y));
    const double z = y * y;
    double sum = 0.0;
    for (int k = 23; k >= 3; k -= 2) sum = ((k / 2) % 2 ? -1.0 : 1.0) / k + z * sum;
    const double angle = 4.0 * (y + y * z * sum);
    return large ? kPi / 2.0 - angle : angle;
}

double angleBetween(const Vec3& a, const Vec3& b)
{
    const Vec3 u = a.normalized();
    const Vec3 v = b.normalized();
    const double across = (u - v).norm();
    const double along = (u + v).norm();
    return 2.0 * (along > 0.0 ? arcTangent(across / along) : kPi / 2.0);
}

Mat3 skew(const Vec3& a)
{
    Mat3 m;
    m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return m;
}

Quat exponentialMap(const Vec3& rotationVector)
{
    const double angle = rotationVector.norm();
    double sine = 0.0, cosine = 1.0;
    double sineOverAngle = 0.5;  // sin(θ/2)/θ
    if (angle > 1e-8) {
        sinCos(0.5 * angle, sine, cosine);
        sineOverAngle = sine / angle;
    }
    const Vec3 v = sineOverAngle * rotationVector;
    return Quat(cosine, v.x(), v.y(), v.z());
}

Vec3 rotationVector(const Quat& rotation)
{
    // q and −q are the same rotation; the one with w ≥ 0 turns by at most π.
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    const Vec3 axisTimesSine = sign * Vec3(rotation.x(), rotation.y(), rotation.z());
    const double sine = axisTimesSine.norm(), cosine = sign * rotation.w();
    if (sine < 1e-12) return 2.0 * axisTimesSine;
    const double angle = 2.0 * (cosine > 0.0 ? arcTangent(sine / cosine) : kPi / 2.0);
    return angle / sine * axisTimesSine;
}

Quat fromEulerXyz(const Vec3& angles)
{
    return (exponentialMap({0.0, 0.0, angles.z()}) * exponentialMap({0.0, angles.y(), 0.0}) *
            exponentialMap({angles.x(), 0.0, 0.0}))
        .normalized();
}

double chordOfTurn(const Quat& from, const Quat& to)
{
    return 2.0 * (to * from.conjugate()).vec().norm();
}

double chordOfTurn(const Mat3& from, const Mat3& to)
{
    // All that a turn does is across its axis, twice.
    return (to - from).norm() / std::numbers::sqrt2;
}

Mat3 inverseInertiaWorld(const Mat3& rotation, const Vec3& inverseMoments)
{
    return rotation * inverseMoments.asDiagonal() * rotation.transpose();
}

Quat rotated(const Quat& orientation, const Vec3& rotationVector)
{
    Quat q = exponentialMap(rotationVector) * orientation;
    const double length = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
    return Quat(q.w() / length, q.x() / length, q.y() / length, q.z() / length);
}

}  // namespace scree
