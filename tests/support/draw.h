// Random numbers and vectors that are the same everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// Draws of one scene, one after the other.
class Draw {
public:
    Draw(std::uint64_t seed, std::uint64_t scene) : seed_(seed), scene_(scene) {}

    double between(double least, double most) { return least + (most - least) * unit(); }
    double magnitude(double least, double most)
    {
        return std::exp(between(std::log(least), std::log(most)));
    }
    int below(int count) { return std::min(static_cast<int>(count * unit()), count - 1); }
    template <class Choices>
    auto of(const Choices& choices)
    {
        return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
    }
    Vec3 vector(double most)
    {
        const double x = between(-most, most), y = between(-most, most);
        return {x, y, between(-most, most)};
    }

private:
    double unit() { return randomUnit(seed_, scene_, drawn_++); }

    std::uint64_t seed_, scene_, drawn_ = 0;
};

}  // namespace scree::test
