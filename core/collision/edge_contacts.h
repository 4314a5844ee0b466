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

/// Two edges of which one may lie in the other body, but where their lines are nearest is past the
/// end of one, or tells no way out. In the frame of the second.
struct PassingEdges {
    Vec3 onFirst, normal;
    double gap;                      ///< of their lines [m]
    double alongFirst, alongSecond;  ///< from the starts of the edges [m]
};

/// What two edges are to each other, if anything.
struct FacedEdges {
    std::optional<FeatureContact> contact;
    std::optional<PassingEdges> passing;
};

/// An edge of either, when their gap is below `reach`.
FacedEdges faceEdges(const RelativePair& pair, std::int32_t ofFirst, std::int32_t ofSecond,
                     double reach, double sharpness);

/// As though passing edges touched, when one lies in the other body deeper than where the distance
/// is `below` < 0 [m]: only as deep as it lies there.
std::optional<FeatureContact> touchInPassing(const RelativePair& pair, std::int32_t ofFirst,
                                             std::int32_t ofSecond, const PassingEdges& passing,
                                             double reach, double below);

}  // namespace scree
