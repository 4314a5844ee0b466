// Capsules that lie as told.
#pragma once

#include "core/geometry/shape.h"

namespace scree::test {

/// Of a capsule at `position` whose axis lies in that direction.
inline Pose lyingAlong(const Shape& capsule, const Vec3& position, const Vec3& direction)
{
    return {position, Quat::FromTwoVectors(capsule.capsule.half, direction)};
}

}  // namespace scree::test
