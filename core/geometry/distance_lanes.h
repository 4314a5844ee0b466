// The distance field of a solid asked for eight spheres of another body at once, in single
// precision: what can be passed over, and how far away the rest is at least.  [A4, A13]
#pragma once

#include "core/geometry/signed_distance.h"
#include "core/geometry/sphere_lanes.h"

namespace scree {

/// What placing and measuring in single precision may lose, as a share of the numbers: some ten
/// operations lose 2⁻²⁴ each.
inline constexpr double kSinglePrecision = 2e-6;

class DistanceLanes {
public:
    /// Rotation and translation lead from the frame of the spheres to that of the field; `extent`
    /// is how far from their origin the spheres reach [m]. Borrows the field.
    DistanceLanes(const SignedDistance& field, const Mat3& rotation, const Vec3& translation,
                  double extent);

    /// Never more than the distance between the solid and each of the spheres [m].
    FloatLanes apartAtLeast(const SphereLanes& spheres) const;

private:
    FloatLanes ofFormula(const FloatLanes3& p) const;
    FloatLanes ofNodes(const FloatLanes3& p) const;

    const SignedDistance& field_;
    RotationLanes rotation_;
    FloatLanes3 translation_;
    FloatLanes rounding_;          // what single precision may have lost [m]
    FloatLanes3 boxMin_, boxMax_;  // of the surface
    FloatLanes3 domainMin_, domainMax_;
    FloatLanes spacing_, inverseSpacing_;  // of the nodes [m], [1/m]
};

}  // namespace scree
