// The facets of a fine mesh that stand for a round surface: where does that face a given way? [A40]
//
// What rolls or lies on facets would do so from corner to corner. Here the surface is known with
// its curvature, so that two that meet can be followed as they turn (`collision/round_contacts`).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/mesh_fans.h"
#include "core/geometry/round_place.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

class RoundFacets {
public:
    RoundFacets() = default;
    /// `mesh` must be closed and manifold.
    explicit RoundFacets(const TriMesh& mesh);

    /// Whether no facet is round: fine, and neither hollow nor beside one that is.
    bool isEmpty() const { return bulge_ <= 0.0; }
    /// Whether all facets are.
    bool areAll() const;
    /// No place of a round facet lies farther below the round surface than this [m].
    double bulge() const { return bulge_; }

    /// Of the round facets around a vertex the one to begin a search with; −1 when there is none.
    std::int32_t atVertex(std::int32_t vertex, const Vec3& direction) const;

    /// Whether all facets around a vertex are round.
    bool areRoundAround(std::int32_t vertex) const;

    /// Walks from a round facet to the one that faces `direction` (unit), and stays there for the
    /// next search.
    RoundSearch findFacing(std::int32_t& triangle, const Vec3& direction, RoundPlace& place) const;

    /// The axis (unit) of a facet that bends about one only, as the side of a capsule does; nothing
    /// of any other.
    std::optional<Vec3> axisOf(std::int32_t triangle) const;
    /// One of the two facets beside an edge of the mesh if both are such; −1 if not.
    std::int32_t sideAtEdge(std::int32_t vertex, std::int32_t other) const;
    /// As findFacing on such a side, for a direction across its axis: the place is any along that.
    RoundSearch findAcross(std::int32_t& triangle, const Vec3& direction, RoundPlace& place) const;

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
    void findNormals();
    void findRoundFacets();

    TriMesh mesh_;
    MeshFans fans_;
    Points normals_;             // 3×#V
    std::vector<char> isRound_;  // per triangle
    double bulge_ = 0.0;         // [m]
};

}  // namespace scree
