// What statics says of bodies at rest, by nothing but the equilibrium of forces: an oracle that
// knows no time.
#pragma once

#include <span>
#include <vector>

#include "core/scene/world.h"

namespace scree::test {

/// A flat place where two bodies touch.
struct Joint {
    BodyId on = 0, against = 0;
    std::vector<Vec3> corners;  ///< world [m]
    Vec3 normal;                ///< of the force on `on`
    std::vector<Vec3> slides;   ///< unit vectors along which friction may act, across the normal
    double friction = 0.0;
};

/// Whether forces at the corners, each in its cone of friction, can carry all movable bodies, with
/// the joints smaller and less rough by the share `spare` (larger and rougher where it is below 0).
/// Where they can, to stay is a motion that obeys all laws; where they cannot, none that stays
/// does.
bool canStand(const World& world, const Vec3& gravity, std::span<const Joint> joints, double spare);

}  // namespace scree::test
