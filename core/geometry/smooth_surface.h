// A fine mesh read as the smooth surface it stands for: where does it face a given way?  [A40]
//
// Of a ball that rests on a plane the flat facets know only corners: it is a corner that is lowest,
// and a ball that rolls from corner to corner loses its speed like a coarse gear wheel.
// Interpolated vertex normals know the foot point between them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// A place where a round part of the surface faces a given way.
struct RoundPlace {
    Vec3 point;    ///< on its facet [m]
    double bulge;  ///< how far the smooth surface lies above the facet there, that way [m]
    Mat3 advance;  ///< what it moves by when that way turns [m/rad]
    /// It is where a side begins that bends one way only, and the way leans over that.
    bool isPastEnd = false;
};

class SmoothSurface {
public:
    SmoothSurface() = default;
    /// `mesh` must be closed and manifold.
    explicit SmoothSurface(const TriMesh& mesh);

    bool isEmpty() const { return normals_.cols() == 0; }

    /// Unit normal of the smooth surface at a vertex.
    Vec3 normalAt(std::int32_t vertex) const { return normals_.col(vertex); }

    /// The place at most three triangles from `vertex` where the interpolated normal is
    /// `direction` (unit). Nothing when there is none, or when a facet on the way turns so much
    /// that it is felt and seen as a facet.
    std::optional<Vec3> placeFacing(std::int32_t vertex, const Vec3& direction) const;

    /// Whether any facet is round: fine, and neither hollow nor beside one that is.
    bool hasRoundFacets() const { return bulge_ > 0.0; }
    /// No place of a round facet lies farther below the smooth surface than this [m].
    double bulge() const { return bulge_; }

    /// Of the round facets around a vertex the one to begin a search with; −1 when there is none.
    std::int32_t roundFacetAt(std::int32_t vertex, const Vec3& direction) const;

    enum class Search { found, elsewhere, onSide, notRound };
    /// Walks from a round facet to the one that faces `direction` (unit), and stays there for the
    /// next search. `elsewhere`: it is more than a few facets away; `onSide`: between lies a side
    /// that bends one way only; `notRound`: a facet that is not round, or the surface does not
    /// bend.
    Search findFacing(std::int32_t& triangle, const Vec3& direction, RoundPlace& place) const;

    /// The axis (unit) of a facet that bends about one only, as the side of a capsule does; nothing
    /// of any other.
    std::optional<Vec3> axisOf(std::int32_t triangle) const;
    /// One of the two facets beside an edge of the mesh if both are such; −1 if not.
    std::int32_t sideAtEdge(std::int32_t vertex, std::int32_t other) const;
    /// As findFacing on such a side, for a direction across its axis: the place is any along that.
    Search findAcross(std::int32_t& triangle, const Vec3& direction, RoundPlace& place) const;

private:
    struct Facet {
        Mat3 points, normals;  // columns by corner
    };
    /// A facet of a side: two corners on a line along the axis, and one beside it.
    struct SideFacet {
        Facet facet;
        Vec3 axis;
        int beside;
        Vec3 normalOfLine() const { return facet.normals.col((beside + 1) % 3); }
    };
    std::optional<SideFacet> sideFacetAt(std::int32_t triangle) const;
    Facet facetAt(std::int32_t triangle) const;
    RoundPlace placeAt(const Facet& facet, const Vec3& weights, const Mat3& change) const;
    void findRoundNormals();
    void findRoundFacets();
    /// Corner weights of the triangle's place that faces `direction`; they add up to 1 and one is
    /// negative when the place lies outside. Nothing when the triangle is a coarse facet or its
    /// normals lie in one plane.
    std::optional<Vec3> weightsFacing(std::int32_t triangle, const Vec3& direction) const;

    TriMesh mesh_;
    Points normals_, roundNormals_;                    // 3×#V
    std::vector<std::array<std::int32_t, 3>> beyond_;  // triangle across the edge opposite a corner
    std::vector<std::int32_t> fanStart_, fan_;         // triangles around every vertex
    std::vector<char> isRound_;                        // per triangle
    double bulge_ = 0.0;                               // [m]
};

}  // namespace scree
