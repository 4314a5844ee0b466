// A corner in a crease of the other surface touches both sides of it. The nearer side alone would
// do if it were always the same: a slab that slides over the floor of a bucket touches it all the
// time, and would be told of the wall when it is deeper in that than in the floor.  [A7, A8]
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/collision/relative_pair.h"

namespace scree {

/// One of the sides of a crease that a corner touches.
struct CreaseContact {
    FeatureContact contact;
    std::int32_t side;  ///< 2 × index of the crease in the second shape, plus which of its faces
};

/// Finds what a corner of the first shape touches in the creases of the second with gaps below
/// `reach` [m], each face once; `known` among them, if that is one of their faces.
void findCreaseContacts(const RelativePair& pair, std::int32_t corner, double reach,
                        const std::optional<FeatureContact>& known,
                        std::vector<CreaseContact>& found);

}  // namespace scree
