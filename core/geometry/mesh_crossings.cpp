// Symbols: a, b, c corners of a triangle, n its area vector, p, q ends of an edge.
#include "core/geometry/mesh_crossings.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "core/base/parallel.h"
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

/// A triangle and its box.
struct Boxed {
    Aabb box;
    int triangle;
};

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
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    std::vector<Boxed> all(count);
    Aabb whole;
    for (std::size_t i = 0; i < count; ++i) {
        all[i].triangle = static_cast<int>(i);
        for (int k = 0; k < 3; ++k)
            all[i].box.include(mesh.points.col(mesh.triangles(k, all[i].triangle)));
        whole.include(all[i].box.min);
        whole.include(all[i].box.max);
    }
    const double tolerance = kTouching * whole.diagonal();

    // Sweep along the longest axis: only triangles whose boxes overlap there can meet.
    int axis = 0;
    whole.size().maxCoeff(&axis);
    std::sort(all.begin(), all.end(), [&](const Boxed& f, const Boxed& g) {
        return std::tuple(f.box.min[axis], f.triangle) < std::tuple(g.box.min[axis], g.triangle);
    });
    std::vector<std::vector<int>> meets(count);
    forEach(count, kShortWork, [&](std::size_t i) {
        const auto& [box, f] = all[i];
        for (std::size_t j = i + 1; j < count && all[j].box.min[axis] <= box.max[axis]; ++j) {
            const int g = all[j].triangle;
            if (box.overlaps(all[j].box) && !sharesPoint(mesh, f, g)) meets[i].push_back(g);
        }
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
    for (std::size_t i = 0; i < count; ++i) {
        for (const int g : meets[i]) {
            test(all[i].triangle, g);
            test(g, all[i].triangle);
        }
    }
    return crossings;
}

}  // namespace scree
