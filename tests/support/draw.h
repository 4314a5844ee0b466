// Random numbers and vectors that are the same everywhere.
#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "core/math/aabb.h"

namespace scree::test {

/// Uniform in −1 … 1.
inline double signedUnit(std::uint64_t stream, std::uint64_t index)
{
    return 2.0 * randomUnit(7, stream, index) - 1.0;
}

inline Vec3 signedUnits(std::uint64_t stream, std::uint64_t first)
{
    return {signedUnit(stream, first), signedUnit(stream, first + 1),
            signedUnit(stream, first + 2)};
}

/// The i-th place of a stream, anywhere in a box.
inline Vec3 randomPlace(std::uint64_t stream, std::uint64_t i, const Aabb& box)
{
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
        p[k] = box.min[k] + box.size()[k] * randomUnit(stream, i, static_cast<std::uint64_t>(k));
    }
    return p;
}

}  // namespace scree::test
