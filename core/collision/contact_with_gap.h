// A place where two bodies face each other, and what found it. What finds such places, lists them
// or thins them out speaks of them in these words, and need not know of each other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// What found a contact. What is round, the solid or the surface that facets stand for, has places
/// of its own.
enum class FeatureKind : std::uint64_t { cornerOfA = 0, cornerOfB = 1, edges = 2, round = 3 };

inline std::uint64_t featureId(FeatureKind kind, std::int32_t first, std::int32_t second = 0)
{
    return static_cast<std::uint64_t>(kind) << 62 | static_cast<std::uint64_t>(first) << 31 |
           static_cast<std::uint64_t>(second);
}

inline FeatureKind kindOf(std::uint64_t feature)
{
    return static_cast<FeatureKind>(feature >> 62);
}

/// Two surfaces facing each other. The normal points from B to A.
struct GapContact {
    std::uint64_t feature;  ///< which features of A and B: the same as long as they stay the same
    Vec3 rA;      ///< the place, halfway between the surfaces, from A's centre of mass, world [m]
    Vec3 normal;  ///< world
    double gap;   ///< [m], negative when they overlap
};

/// Depth of the deepest overlap; 0 when all are apart [m].
double deepestOf(const std::vector<GapContact>& contacts);

/// How the surfaces of two bodies have moved, seen from A's centre of mass.
struct PairMove {
    Mat3 turnA, turnB;
    Vec3 fromAToBBefore, fromAToB;  ///< between their centres [m]
};

/// The contact after its bodies have moved. A corner is a point of its body and a face a plane of
/// the other, so that it is the one that would be found; where two edges cross it is as good as the
/// turn is small. The place of a round contact is no point of its bodies.
GapContact movedAlong(const GapContact& contact, const PairMove& move);

}  // namespace scree
