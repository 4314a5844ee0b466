// Random numbers without a stream: every draw is a hash of what it is for (seed, name, frame,
// index), so that no draw depends on how many came before it, on threads or on a resume.  [A21]
#pragma once

#include <cstdint>

#include "core/base/hash.h"

namespace scree {

/// The word drawn for (seed, a, b, c).
constexpr std::uint64_t randomBits(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0,
                                   std::uint64_t c = 0)
{
    constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;
    return mixBits(mixBits(mixBits(mixBits(seed + kStep) + a + kStep) + b + kStep) + c + kStep);
}

/// Uniform in [0, 1).
constexpr double randomUnit(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0,
                            std::uint64_t c = 0)
{
    return static_cast<double>(randomBits(seed, a, b, c) >> 11) * 0x1.0p-53;
}

/// Uniform in 0 … count − 1; the bias of the remainder is below 2⁻³² for the counts used here.
constexpr std::uint64_t randomIndex(std::uint64_t count, std::uint64_t seed, std::uint64_t a,
                                    std::uint64_t b = 0, std::uint64_t c = 0)
{
    return randomBits(seed, a, b, c) % count;
}

}  // namespace scree
