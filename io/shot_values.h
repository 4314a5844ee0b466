// Small helpers for whoever turns a checked shot's tree into values: counts and kinds have been
// checked before.
#pragma once

#include <array>
#include <initializer_list>

#include "core/math/rotation.h"
#include "core/math/types.h"
#include "io/shot_tree.h"

namespace scree {

inline constexpr double kRadiansPerDegree = kPi / 180.0;

/// Of a list of three numbers.
inline Vec3 toVec3(const ShotNode& node)
{
    return {node.items[0].number, node.items[1].number, node.items[2].number};
}

/// Of a list of N whole numbers.
template <std::size_t N>
std::array<int, N> toInts(const ShotNode& node)
{
    std::array<int, N> result{};
    for (std::size_t i = 0; i < N; ++i) result[i] = static_cast<int>(node.items[i].integer);
    return result;
}

/// Whether a table has one of the keys, rightly or wrongly.
inline bool mentionsAny(const ShotNode& node, std::initializer_list<const char*> keys)
{
    for (const char* key : keys) {
        if (node.mentions(key)) return true;
    }
    return false;
}

}  // namespace scree
