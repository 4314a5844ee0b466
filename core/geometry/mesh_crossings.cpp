// Symbols: a, b, c corners of a triangle, n its area vector, p, q ends of an edge.
#include "core/geometry/mesh_crossings.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kTouching = 1e-6;  // of the mesh's diagonal

/// Where the edge pq goes through the triangle; both ends are farther from its plane, and the
/// crossing farther from its border, than `tolerance`.
std::optional<Vec3> pierce(const TriangleCorners& t, const Vec3& p, const Vec3& q, double tolerance)
{
    const Vec3 n = t.areaVector();
    const double length = n.norm();
    if (!(length > 0.0)) return std::nullopt;
    const double above = n.dot(p - t.a) / length, below = n.dot(q - t.a) / length;
    const bool crosses =
        (above > tolerance && below < -tolerance) || (above < -tolerance && below > tolerance);
    if (!crosses) return std::nullopt;
    const Vec3 place = p + above / (above - below) * (q - p);
    const auto isInside = [&](const Vec3& from, const Vec3& to) {
        const Vec3 edge = to - from;
        return n.dot(edge.cross(place - from)) > tolerance * length * edge.norm();
    };
    const bool hits = isInside(t.a, t.b) && isInside(t.b, t.c) && isInside(t.c, t.a);
    return hits ? std::optional<Vec3>(place) : std::nullopt;
}

bool sharesPoint(const TriMesh& mesh, int f, int g)
{
    for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
            if (mesh.triangles(k, f) == mesh.triangles(l, g)) return true;
        }
    }
    return false;
}

}  // namespace

std::vector<MeshCrossing> findCrossings(const TriMesh& mesh)
{
    const int count = static_cast<int>(mesh.triangles.cols());
    std::vector<Aabb> boxes(count);
    Aabb whole;
    for (int f = 0; f < count; ++f) {
        for (int k = 0; k < 3; ++k) boxes[f].include(mesh.points.col(mesh.triangles(k, f)));
        whole.include(boxes[f].min);
        whole.include(boxes[f].max);
    }
    const double tolerance = kTouching * whole.diagonal();

    // Sweep along the longest axis: only triangles whose boxes overlap there can meet.
    int axis = 0;
    whole.size().maxCoeff(&axis);
    std::vector<int> order(count);
    for (int f = 0; f < count; ++f) order[f] = f;
    std::sort(order.begin(), order.end(), [&](int f, int g) {
        return std::tuple(boxes[f].min[axis], f) < std::tuple(boxes[g].min[axis], g);
    });
    std::set<std::tuple<int, int, int>> seen;  // an edge has two faces and is told once
    std::vector<MeshCrossing> crossings;
    const auto test = [&](int pierced, int other) {
        const TriangleCorners corners = cornersOf(mesh, pierced);
        for (int k = 0; k < 3; ++k) {
            const int p = mesh.triangles(k, other), q = mesh.triangles((k + 1) % 3, other);
            const auto place = pierce(corners, mesh.points.col(p), mesh.points.col(q), tolerance);
            if (place && seen.emplace(pierced, std::min(p, q), std::max(p, q)).second) {
                crossings.push_back({pierced, *place});
            }
        }
    };
    for (int i = 0; i < count; ++i) {
        const int f = order[i];
        for (int j = i + 1; j < count && boxes[order[j]].min[axis] <= boxes[f].max[axis]; ++j) {
            const int g = order[j];
            if (!boxes[f].overlaps(boxes[g]) || sharesPoint(mesh, f, g)) continue;
            test(f, g);
            test(g, f);
        }
    }
    return crossings;
}

}  // namespace scree
