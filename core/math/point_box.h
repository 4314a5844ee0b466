// The axis-aligned box around points.
#pragma once

#include "core/math/aabb.h"

namespace scree {

inline Aabb boxOf(const Points& points)
{
    Aabb box;
    for (Eigen::Index i = 0; i < points.cols(); ++i) box.include(points.col(i));
    return box;
}

}  // namespace scree
