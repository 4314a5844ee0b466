// Forces that fill space: a wind that drags bodies along, a pull or push from a point, a vortex
// about an axis, a push in one direction.  [A56]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// How a field weakens with distance d from its centre (of a vortex: from its axis), by the
/// distance `reach`.
enum class Falloff {
    none,
    linear,         ///< 1 − d/reach, 0 beyond
    smooth,         ///< (1 − d²/reach²)², 0 beyond: without a kink
    inverseSquare,  ///< 1/(1 + d²/reach²): half at reach, felt everywhere
};

struct StrengthKey {
    double time = 0.0;      ///< [s]
    double strength = 0.0;  ///< unit of ForceField::strength
};

/// Fields act on centres of mass and so turn nothing. Pushes and vortices are accelerations, so
/// that light and heavy props follow alike; only wind asks how large a body is.
struct ForceField {
    enum class Kind { wind, radial, vortex, uniform };

    std::string name;
    Kind kind = Kind::radial;
    double strength = 0.0;  ///< wind: speed of the air [m/s]; else acceleration [m/s²]; a radial
                            ///< one above 0 pushes outward
    std::vector<StrengthKey> keys;  ///< instead of strength, in order of time: linear, held outside
    Vec3 centre = Vec3::Zero();     ///< [m]; of wind: where it is strongest
    Vec3 direction = Vec3::UnitY();  ///< unit; of a wind or a push, or of a vortex's axis
    Falloff falloff = Falloff::none;
    double reach = 1.0;  ///< [m], > 0
    double drag = 1.0;   ///< of wind: drag coefficient on a quarter of a body's surface, which is
                         ///< the area a convex body shows on average [-]
    std::uint64_t groups = ~std::uint64_t{0};  ///< acts on the bodies in one of these
};

}  // namespace scree
