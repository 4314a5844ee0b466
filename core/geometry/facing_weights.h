// Where in a facet, whose normal is interpolated between its corners, does it face a given way?
#pragma once

#include <Eigen/LU>

#include <optional>

#include "core/math/types.h"

namespace scree {

/// Corner weights of the place of a facet that faces a direction, and how they change with it.
struct FacingWeights {
    Vec3 weights;  ///< they add up to 1; one is negative when the place lies outside
    Mat3 change;   ///< less what keeps their sum
};

inline constexpr double kOutsideFacet =
    -1e-9;  ///< a weight above this is not outside; for rounding

/// Nothing when the normals (columns by corner) span less than `leastVolume`, that is, lie in one
/// plane, or look the other way.
inline std::optional<FacingWeights> facingWeights(const Mat3& normals, const Vec3& direction,
                                                  double leastVolume)
{
    Mat3 inverse;
    bool isInvertible = false;
    normals.computeInverseWithCheck(inverse, isInvertible, leastVolume);
    if (!isInvertible) return std::nullopt;
    const Vec3 weights = inverse * direction;
    const double sum = weights.sum();
    if (!(sum > 0.0)) return std::nullopt;
    return FacingWeights{weights / sum, inverse / sum};
}

}  // namespace scree
