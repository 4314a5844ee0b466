// Of the many places where two bodies lie flat on each other those that matter: a ring on the floor
// has thirty-two, and eight hold it as well.  [MEM20; algorithm 14]
#pragma once

#include <cstddef>
#include <vector>

#include "core/collision/contact_with_gap.h"

namespace scree {

/// Keeps, of contacts[first] and those that follow it, what says all of the others too, in their
/// order. How fast a gap closes is linear in the place across the normal, so that of those with one
/// normal only the lower hull of place and gap can be the first to close; where many normals leave
/// many, so about it is for those that differ little. `worldFromBody`: of one
/// of the bodies; the choice turns with it, so that what lies still keeps what it has. `size`: of
/// the smaller body [m].
void reduceContacts(std::vector<GapContact>& contacts, std::size_t first, const Mat3& worldFromBody,
                    double size);

}  // namespace scree
