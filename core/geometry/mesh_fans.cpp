#include "core/geometry/mesh_fans.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace scree {

MeshFans::MeshFans(const TriMesh& mesh)
    : beyond_(static_cast<std::size_t>(mesh.triangles.cols()), {-1, -1, -1}),
      fanStart_(static_cast<std::size_t>(mesh.points.cols()) + 1, 0),
      fan_(static_cast<std::size_t>(mesh.triangles.size()))
{
    std::map<std::pair<int, int>, std::pair<std::int32_t, int>> cornerOfEdge;
    for (std::int32_t f = 0; f < triangleCount(); ++f) {
        for (int k = 0; k < 3; ++k) {
            ++fanStart_[static_cast<std::size_t>(mesh.triangles(k, f)) + 1];
            const auto edge =
                std::minmax(mesh.triangles((k + 1) % 3, f), mesh.triangles((k + 2) % 3, f));
            const auto [other, isNew] = cornerOfEdge.try_emplace(edge, f, k);
            if (isNew) continue;
            beyond_[f][k] = other->second.first;
            beyond_[other->second.first][other->second.second] = f;
        }
    }
    std::partial_sum(fanStart_.begin(), fanStart_.end(), fanStart_.begin());
    std::vector<std::int32_t> next(fanStart_.begin(), fanStart_.end() - 1);
    for (std::int32_t f = 0; f < triangleCount(); ++f) {
        for (int k = 0; k < 3; ++k) fan_[next[mesh.triangles(k, f)]++] = f;
    }
}

}  // namespace scree
