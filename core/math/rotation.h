// Rotations: cross-product matrices, the exponential map, and sines whose bits are ours.
//
// Nothing that moves bodies may call the C library's sin, cos or acos: glibc picks another version,
// with other last bits, when the processor has fused multiply-add.
#pragma once

#include "core/math/types.h"

namespace scree {

inline constexpr double kPi = 3.14159265358979323846;

/// Sine and cosine of x [rad], |x| ≤ 1e6, within 1 ulp or so of the true values.
void sinCos(double x, double& sine, double& cosine);

/// Arc tangent of x ≥ 0 [rad]; π/2 of what is no number.
double arcTangent(double x);

/// Angle between two vectors of any non-zero length [rad], accurate for small and straight angles.
double angleBetween(const Vec3& a, const Vec3& b);

/// a × b as a matrix acting on b.
Mat3 skew(const Vec3& a);

/// The quaternion of a rotation vector (axis × angle [rad]): exp of the pure quaternion θ/2.
Quat exponentialMap(const Vec3& rotationVector);

/// The rotation vector of a unit quaternion, by the shorter way round: length 0 … π [rad].
Vec3 rotationVector(const Quat& rotation);

/// The unit quaternion of R = Rz·Ry·Rx for angles [rad] about x, y, z: about x first.
Quat fromEulerXyz(const Vec3& angles);

/// How far the turn from one orientation to another takes a point at unit distance, at most: the
/// chord of its angle.
double chordOfTurn(const Quat& from, const Quat& to);
double chordOfTurn(const Mat3& from, const Mat3& to);

/// I⁻¹ in world axes from inverse principal moments: R diag(d) Rᵀ.
Mat3 inverseInertiaWorld(const Mat3& rotation, const Vec3& inverseMoments);

/// exp(rotationVector) q, normalised.  [A19]
Quat rotated(const Quat& orientation, const Vec3& rotationVector);

}  // namespace scree
