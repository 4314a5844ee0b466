// How a corner of a body faces the surface of another. Corners are points, so that one question to
// the distance field of the other body tells most of it; what is left is which of several faces
// about as near the corner stands on.  [A7, A8]
#pragma once

#include <cstdint>
#include <optional>

#include "core/collision/relative_pair.h"

namespace scree {

/// What a corner and a surface are to each other.
struct FacedCorner {
    std::optional<FeatureContact> contact;
    /// If not, as though it were one: the corner lies inside, but what surrounds it would have had
    /// to pass through the surface first.
    std::optional<FeatureContact> unsupported;
    double apart = 0.0, within = 0.0;  ///< if neither, their distance at least and at most [m]
};

/// A corner of the first shape and the surface of the second, which are in contact when nearer than
/// `reach` [m]: only when they are, so that a corner known to be farther away need not be asked
/// about. Nearer than `sharpness` to an edge, the faces beside it decide the normal [m].
FacedCorner faceCorner(const RelativePair& pair, std::int32_t corner, double reach,
                       double sharpness);

}  // namespace scree
