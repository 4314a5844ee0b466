// A fine mesh read as the smooth surface it stands for: where does it face a given way?  [A40]
//
// Of a ball that rests on a plane the flat facets know only corners: it is a corner that is lowest,
// and a ball that rolls from corner to corner loses its speed like a coarse gear wheel.
// Interpolated vertex normals know the foot point between them. Method `paper` moves its samples
// there; method `scree` asks RoundFacets, which know the curvature besides.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/mesh_fans.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

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

private:
    /// Corner weights of the triangle's place that faces `direction`; they add up to 1 and one is
    /// negative when the place lies outside. Nothing when the triangle is a coarse facet or its
    /// normals lie in one plane.
    std::optional<Vec3> weightsFacing(std::int32_t triangle, const Vec3& direction) const;

    TriMesh mesh_;
    MeshFans fans_;
    Points normals_;  // 3×#V
};

}  // namespace scree
