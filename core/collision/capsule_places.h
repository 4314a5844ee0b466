// Where a capsule touches a mesh: with its ends as two balls would, and in between at edges and
// corners that its axis passes.  [A9; algorithm 14]
//
// As a mesh of its own it has five hundred edges to ask, and most of them face nothing: in a mixer
// where every fourth body was one they took nearly half of the time of all contacts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/collision/ball_contacts.h"
#include "core/collision/relative_pair.h"
#include "core/collision/round_contacts.h"

namespace scree {

/// Between its ends.
struct CapsulePlace {
    ContactPart ofMesh;                 ///< an edge or a corner
    std::array<std::int32_t, 2> place;  ///< as of BallContact
    FeatureContact contact;
};

struct CapsulePlaces {
    std::array<std::vector<BallContact>, 2> ofEnd;  ///< at minus and plus half of the axis
    std::vector<CapsulePlace> between;
};

/// Of the first shape, a capsule, with the second, a mesh: the contacts with gaps below `reach`
/// [m]. Answers how far apart the two are at least [m]; nothing where the axis of the capsule comes
/// inside of the mesh, of which its facets must tell.
std::optional<double> findCapsulePlaces(const RelativePair& pair, double reach,
                                        CapsulePlaces& found);

}  // namespace scree
