// Vectors drawn by counters, the same in every run.
#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "core/math/types.h"

namespace scree::test {

/// Within `size` either way along each axis.
inline Vec3 drawVector(std::uint64_t i, std::uint64_t what, double size)
{
    const auto unit = [&](std::uint64_t axis) {
        return size * (2.0 * randomUnit(31, i, what, axis) - 1.0);
    };
    return {unit(0), unit(1), unit(2)};
}

}  // namespace scree::test
