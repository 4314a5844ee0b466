#pragma once

#include "core/math/types.h"

namespace scree {

/// What a ball sweeps that moves along a segment about the origin, from -half to half.
struct Capsule {
    Vec3 half = Vec3::Zero();  ///< [m]; zero of a ball
    double radius = 0.0;       ///< [m]

    bool isBall() const { return half.isZero(0.0); }
};

}  // namespace scree
