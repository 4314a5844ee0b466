// Which triangles of a closed mesh lie around a point and beyond an edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

class MeshFans {
public:
    MeshFans() = default;
    /// `mesh` must be closed and manifold.
    explicit MeshFans(const TriMesh& mesh);

    std::int32_t triangleCount() const { return static_cast<std::int32_t>(beyond_.size()); }

    /// Triangles around a point of the mesh, ascending.
    std::span<const std::int32_t> around(std::int32_t vertex) const
    {
        return std::span(fan_).subspan(fanStart_[vertex],
                                       fanStart_[vertex + 1] - fanStart_[vertex]);
    }

    /// The triangles across the edges opposite the three corners.
    const std::array<std::int32_t, 3>& beyond(std::int32_t triangle) const
    {
        return beyond_[triangle];
    }

private:
    std::vector<std::array<std::int32_t, 3>> beyond_;
    std::vector<std::int32_t> fanStart_, fan_;
};

}  // namespace scree
