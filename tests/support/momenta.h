// What collisions must keep.
#pragma once

#include "core/scene/world.h"

namespace scree::test {

/// Of all bodies, which are movable, about the origin [kg m²/s].
inline Vec3 angularMomentumOf(const World& world)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const BodyMotion& motion = world.motion[b];
        sum += motion.position.cross(motion.velocity / world.mass[b].inverseMass) +
               motion.angularMomentum;
    }
    return sum;
}

}  // namespace scree::test
