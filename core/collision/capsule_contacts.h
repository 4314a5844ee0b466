// Where a capsule, or a ball, touches another one or a plane: the distance of their segments tells.
// [A9; algorithm 14]
//
// As meshes, four hundred beans in a box took sixteen times as long to find contacts as as many
// marbles.
#pragma once

#include <cstdint>
#include <vector>

#include "core/collision/relative_pair.h"

namespace scree {

/// A contact, and which parts of the two it is of: 0 between the ends, else 1 or 2 for an end.
struct CapsuleContact {
    std::int32_t ofFirst, ofSecond;
    FeatureContact contact;
};

/// Of the first, a capsule, with the second, which is one too or a plane: the contacts with gaps
/// below `reach` [m]. Answers how far the two are apart, negative where they overlap [m].
double findCapsuleContacts(const RelativePair& pair, double reach,
                           std::vector<CapsuleContact>& found);

}  // namespace scree
