// The edges of a mesh that stand for round curves, such as the rims of a can, a coin or a wheel:
// where does such a curve face a given way?  [A40]
//
// These are sharp, or, of a solid of revolution, lie around it: a tyre with a bevel of 20° on its
// tread lost a seventh of its speed in a second where one of 21° lost nothing.
//
// A wheel told of its corners rolls like a gear: those that are about to touch lie ahead, and
// brake. A can that should have rolled at 2 m/s for ever lost half of that in 4 s, with 1024 sides
// as with 128.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/contact_features.h"
#include "core/geometry/round_place.h"

namespace scree {

class RoundRims {
public:
    RoundRims() = default;
    /// Of a solid mesh, all in its object frame. `turnsThatShow`: about which axes it is no solid
    /// of revolution (revolution.h).
    explicit RoundRims(const ContactFeatures& features, const Vec3& turnsThatShow = Vec3::Ones());

    /// No place of an edge lies farther below its curve than this [m]; 0 where there is none.
    double bulge() const { return bulge_; }

    /// Where to begin a search: one of the rim edges at a corner of the mesh, or the one that a
    /// convex edge is; −1 where there is none.
    std::int32_t atCorner(std::int32_t corner) const { return of(rimOfCorner_, corner); }
    std::int32_t ofEdge(std::int32_t edge) const { return of(rimOfEdge_, edge); }

    /// As RoundFacets::findFacing. `notRound`: the rim, too, lies almost flat that way, as that
    /// of a standing can on the ground, or another rim or an edge goes on from there.
    RoundSearch findFacing(std::int32_t& rim, const Vec3& direction, RoundPlace& place) const;

private:
    /// Between two corners of the mesh.
    struct Rim {
        std::array<Vec3, 2> ends, tangents;  ///< tangents: unit, from the first end to the second
        std::array<std::int32_t, 2> next;    ///< the rim edge beyond either end; −1: none
        std::array<Vec3, 2> intoFace;        ///< as of ConvexEdge
    };

    std::int32_t of(const std::vector<std::int32_t>& list, std::int32_t item) const
    {
        return rims_.empty() ? -1 : list[item];
    }

    std::vector<Rim> rims_;
    std::vector<std::int32_t> rimOfCorner_, rimOfEdge_;  // per point of the mesh; per convex edge
    double bulge_ = 0.0;                                 // [m]
};

}  // namespace scree
