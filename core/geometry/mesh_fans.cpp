#include "core/geometry/mesh_fans.h"

#include <numeric>

#include "core/geometry/mesh_edges.h"

namespace scree {

MeshFans::MeshFans(const TriMesh& mesh)
    : beyond_(static_cast<std::size_t>(mesh.triangles.cols()), {-1, -1, -1}),
      fanStart_(static_cast<std::size_t>(mesh.points.cols()) + 1, 0),
      fan_(static_cast<std::size_t>(mesh.triangles.size()))
{
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        if (sides.size() < 2) return;
        const auto opposite = [](const TriangleSide& side) { return (side.corner + 2) % 3; };
        const TriangleSide &a = sides.front(), &b = sides.back();
        beyond_[a.triangle][opposite(a)] = b.triangle;
        beyond_[b.triangle][opposite(b)] = a.triangle;
    });
    for (std::int32_t f = 0; f < triangleCount(); ++f) {
        for (int k = 0; k < 3; ++k) ++fanStart_[static_cast<std::size_t>(mesh.triangles(k, f)) + 1];
    }
    std::partial_sum(fanStart_.begin(), fanStart_.end(), fanStart_.begin());
    std::vector<std::int32_t> next(fanStart_.begin(), fanStart_.end() - 1);
    for (std::int32_t f = 0; f < triangleCount(); ++f) {
        for (int k = 0; k < 3; ++k) fan_[next[mesh.triangles(k, f)]++] = f;
    }
}

}  // namespace scree
