#include "core/geometry/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace scree {

/// By their low points first, of which few sides have the same.
MeshEdges::MeshEdges(const TriMesh& mesh) : sides_(static_cast<std::size_t>(mesh.triangles.size()))
{
    const auto sideOf = [&](std::int32_t triangle, int corner) {
        const int from = mesh.triangles(corner, triangle);
        const int to = mesh.triangles((corner + 1) % 3, triangle);
        return TriangleSide{std::min(from, to), std::max(from, to), triangle, corner, from < to};
    };
    const auto triangles = static_cast<std::int32_t>(mesh.triangles.cols());
    std::vector<std::size_t> end(static_cast<std::size_t>(mesh.points.cols()) + 1, 0);
    for (std::int32_t f = 0; f < triangles; ++f) {
        for (int k = 0; k < 3; ++k) ++end[static_cast<std::size_t>(sideOf(f, k).low) + 1];
    }
    std::partial_sum(end.begin(), end.end(), end.begin());
    for (std::int32_t f = 0; f < triangles; ++f) {
        for (int k = 0; k < 3; ++k) {
            const TriangleSide side = sideOf(f, k);
            sides_[end[static_cast<std::size_t>(side.low)]++] = side;
        }
    }
    auto begin = sides_.begin();
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const auto next = sides_.begin() + static_cast<std::ptrdiff_t>(end[v]);
        std::sort(begin, next, [](const TriangleSide& a, const TriangleSide& b) {
            return std::tie(a.high, a.triangle, a.corner) < std::tie(b.high, b.triangle, b.corner);
        });
        begin = next;
    }
}

}  // namespace scree
