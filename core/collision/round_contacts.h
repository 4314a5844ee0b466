// Contacts of fine meshes read as the smooth bodies they stand for.  [A40; algorithm 14]
//
// Told of its corners and edges alone, a ball of 1280 triangles is a polyhedron: it lost two thirds
// of its speed in 6 s of rolling, for the corner that touches next lies ahead and brakes; and a
// blow between two such balls glances off a facet. So a contact that flat features have found is
// moved to where the two smooth surfaces face each other. All features around such a place answer
// with the same one.
#pragma once

#include <cstdint>
#include <optional>

#include "core/collision/relative_pair.h"

namespace scree {

/// What of a shape a contact of features is about.
struct ContactPart {
    enum class Kind { face, corner, edge, ball };
    Kind kind;
    /// Of the corner in the mesh or of the edge among the convex ones; of a capsule, which is of
    /// kind ball, 0 between its ends, else 1 or 2 for an end.
    std::int32_t index = 0;
};

struct Rounding {
    enum class Result {
        none,      ///< neither body is round there
        rounded,   ///< `contact` is
        elsewhere  ///< round, but this is not where they touch
    };
    Result result = Result::none;
    FeatureContact contact = {};
    /// Which parts it is of: 0 where a body is round or flat, else its sharp corner or edge, or the
    /// end of a capsule.
    std::int32_t first = 0, second = 0;
};

/// The contact of two parts where the surfaces that the meshes stand for are nearest. The gap then
/// is that of the smooth surfaces: facets hover by no more than they lie below these.
Rounding roundContact(const RelativePair& pair, ContactPart ofFirst, ContactPart ofSecond,
                      const FeatureContact& contact);

/// The place of a rim near `near` that is touched from the direction `outward`, all in the frame of
/// the shape; nothing where it has no rim.
std::optional<Vec3> placeOnRim(const Shape& shape, const Vec3& near, const Vec3& outward);

}  // namespace scree
