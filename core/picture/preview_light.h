// The light of preview pictures, for the engines that draw them and for the formats that carry it
// to other programs: a sun, a sky above and light thrown back below. In linear light; strengths are
// what a white surface scatters back.
#pragma once

#include "core/math/types.h"

namespace scree {

/// Direction to the sun, with +y up; turned for scenes whose up axis is z.
inline const Vec3 kTowardSun(-0.30, 0.80, 0.55);

inline const Vec3 kSunLight(1.02, 0.9384, 0.816);
inline const Vec3 kZenithColor(0.10, 0.15, 0.22);
inline const Vec3 kHorizonColor(0.30, 0.34, 0.39);
inline const Vec3 kNadirColor(0.10, 0.105, 0.115);
inline const Vec3 kSkyLight(0.22, 0.27, 0.35);
inline const Vec3 kGroundLight(0.15, 0.125, 0.10);

}  // namespace scree
