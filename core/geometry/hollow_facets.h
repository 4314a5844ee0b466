// Where the facets of a mesh bend inward, as in a cup or a bore, and how narrowly.
//
// What is round stands above its facets, and what is hollow is touched as drawn: of two cups of
// twenty sides the upper one floated 3 mm above the lower one, into which it fits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

class HollowFacets {
public:
    HollowFacets() = default;
    /// `mesh` must be closed and manifold.
    explicit HollowFacets(const TriMesh& mesh);

    bool isEmpty() const { return bends_.empty(); }

    /// Whether what is round, and moves by `advance` when the direction it faces turns [m/rad], has
    /// about the radius of a hollow that the facet is of and does not go into it where it stands
    /// above its own facets, by at most `bulge` [m].
    bool isFittedBy(std::int32_t triangle, const Mat3& advance, double bulge) const;

private:
    /// Over the edge across which the facet bends inward most narrowly.
    struct Bend {
        Eigen::Vector3f across = Eigen::Vector3f::Zero();  ///< the edge, in the facet; unit
        /// Of prisms whose sides bend so and are as wide as either facet; the facets of a cup are
        /// wider at its brim. Zero: it bends nowhere [m].
        float least = 0.0f, most = 0.0f;
    };
    std::vector<Bend> bends_;  // per triangle; empty where nothing bends inward
};

}  // namespace scree
