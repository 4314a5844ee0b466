// The edges of a mesh, and the triangles that have them for sides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// A side of a triangle, along an edge between two points.
struct TriangleSide {
    std::int32_t low, high;  ///< these points, low < high
    std::int32_t triangle;
    int corner;  ///< of the triangle, at which it begins
    bool isUp;   ///< it begins at `low`
};

class MeshEdges {
public:
    explicit MeshEdges(const TriMesh& mesh);

    /// Calls visit(sides) once for every edge, ascending by its points; the sides are in the order
    /// of their triangles. Of a solid they are two.
    template <class Visit>
    void forEach(const Visit& visit) const
    {
        for (std::size_t begin = 0, end; begin < sides_.size(); begin = end) {
            end = begin + 1;
            while (end < sides_.size() && sides_[end].low == sides_[begin].low &&
                   sides_[end].high == sides_[begin].high) {
                ++end;
            }
            visit(std::span(sides_).subspan(begin, end - begin));
        }
    }

private:
    std::vector<TriangleSide> sides_;
};

}  // namespace scree
