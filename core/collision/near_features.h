// Narrow phase of method `scree`: the places where two bodies are close to each other, found while
// they are still apart. Corners of each against the surface of the other, and pairs of convex
// edges; each gives a point, a normal and a gap.  [A7, A8; algorithm 14]
//
// Where the features of a fine mesh stand for a round surface, the places of that surface take over
// (round_contacts.h).
//
// A gap, unlike an interference, is known before anything has gone wrong, and is a smooth function
// of the poses, so that one detection serves a whole step.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/collision/interference.h"
#include "core/collision/relative_pair.h"
#include "core/geometry/shape.h"

namespace scree {

/// What found a contact. A pair that has an exact ball in it has no other features.
enum class FeatureKind : std::uint64_t {
    cornerOfA = 0,
    cornerOfB = 1,
    edges = 2,
    ball = 3,
    round = 3
};

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

/// Lower bound of the distance between two bodies, from a few spheres around their features [m];
/// far below zero where these overlap.
double apartAtLeast(const PlacedPair& bodies);

/// The features of a pair that may come within reach, remembered while the pair moves little. The
/// memory changes no result: what is found depends on the poses and the reach alone. Most pairs
/// whose boxes meet are far apart and have none: with one each ten thousand rings took a seventh
/// more memory.
class NearFeatures {
public:
    NearFeatures();
    ~NearFeatures();
    NearFeatures(NearFeatures&&) noexcept;
    NearFeatures& operator=(NearFeatures&&) noexcept;

    /// Appends all contacts with gaps below `reach` [m], in an order of the shapes. Answers how far
    /// apart the bodies are at least: once the points of both have moved in the world by at most m,
    /// added up, there is no contact with a gap below that less m [m].
    double findContacts(const PlacedPair& pair, double reach, std::vector<GapContact>& contacts);

    /// Memories lie scattered: what is asked soon can be fetched beforehand, first what it is, then
    /// what it lists.
    void prefetch() const;
    void prefetchLists() const;

private:
    class Memory;
    std::unique_ptr<Memory> memory_;  // none while everything is far
};

}  // namespace scree
