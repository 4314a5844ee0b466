#pragma once

#include "core/math/types.h"

namespace scree {

struct Ball {
    Vec3 centre = Vec3::Zero();  ///< [m]
    double radius = 0.0;         ///< [m]
};

}  // namespace scree
