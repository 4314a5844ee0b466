// How an edge of a body faces an edge of another. Where two bodies lie deep in each other many
// edges pass each other that are not what touches: most of this tells those from the ones that are.
// Which pairs are worth asking is told eight at a time in edge_lanes.h.  [A7, A8]
#pragma once

#include <cstdint>
#include <optional>

#include "core/collision/relative_pair.h"

namespace scree {

/// Edges closer to parallel than this meet nowhere in particular: their ends speak for them [-].
inline constexpr double kParallel = 1e-3;

/// Lines of edges that are closest past the ends of these by no more than so many times their
/// overlap may still be what touches, in the notch of a hollow outline.
inline constexpr double kPastEnds = 5.0;

/// What two edges are to each other, if anything.
struct FacedEdges {
    std::optional<FeatureContact> contact;
    /// If not: where their lines are nearest is past the end of one, or tells no way out, but one
    /// may lie in the other body all the same. The gap is that of their lines.
    std::optional<FeatureContact> passing;
};

/// An edge of either, when their gap is below `reach`.
FacedEdges faceEdges(const RelativePair& pair, std::int32_t ofFirst, std::int32_t ofSecond,
                     double reach, double sharpness);

/// As though edges that pass each other touched, when one lies in the other body where the distance
/// is `below` < 0 or less [m]: only as deep as it lies there.
std::optional<FeatureContact> touchInPassing(const RelativePair& pair, std::int32_t ofFirst,
                                             std::int32_t ofSecond, const FeatureContact& passing,
                                             double reach, double below);

}  // namespace scree
