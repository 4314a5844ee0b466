#include "core/geometry/tri_mesh.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "core/math/rotation.h"

namespace scree {

double TriangleCorners::angleAt(int k) const
{
    const Vec3& corner = (*this)[k];
    return angleBetween((*this)[(k + 1) % 3] - corner, (*this)[(k + 2) % 3] - corner);
}

TriMesh mergeEqualPoints(const TriMesh& mesh, FlatTriangles flat)
{
    const auto before = [&](int a, int b) {
        const Vec3 p = mesh.points.col(a), q = mesh.points.col(b);
        return std::tuple(p.x(), p.y(), p.z(), a) < std::tuple(q.x(), q.y(), q.z(), b);
    };
    std::vector<int> sorted(mesh.points.cols());
    for (int i = 0; i < static_cast<int>(sorted.size()); ++i) sorted[i] = i;
    std::sort(sorted.begin(), sorted.end(), before);

    // The first of each run of equal points (the lowest index) stands for all of them.
    std::vector<int> standsFor(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const bool same = i > 0 && mesh.points.col(sorted[i]) == mesh.points.col(sorted[i - 1]);
        standsFor[sorted[i]] = same ? standsFor[sorted[i - 1]] : sorted[i];
    }

    std::vector<std::array<int, 3>> kept;
    std::vector<Eigen::Index> keptFrom;  // their triangles in `mesh`
    std::vector<char> used(sorted.size(), 0);
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        std::array<int, 3> t{};
        for (int k = 0; k < 3; ++k) t[k] = standsFor[mesh.triangles(k, f)];
        const bool isFlat = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if (isFlat && flat == FlatTriangles::drop) continue;
        for (int v : t) used[v] = 1;
        kept.push_back(t);
        keptFrom.push_back(f);
    }

    std::vector<int> newIndex(sorted.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v]) newIndex[v] = count++;
    }
    TriMesh merged;
    merged.points.resize(3, count);
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v]) merged.points.col(newIndex[v]) = mesh.points.col(v);
    }
    merged.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t f = 0; f < kept.size(); ++f) {
        for (int k = 0; k < 3; ++k) merged.triangles(k, f) = newIndex[kept[f][k]];
    }
    if (mesh.cornerUvs.cols() == 0) return merged;
    merged.cornerUvs.resize(2, merged.triangles.size());
    for (std::size_t f = 0; f < kept.size(); ++f) {
        merged.cornerUvs.middleCols<3>(3 * f) = mesh.cornerUvs.middleCols<3>(3 * keptFrom[f]);
    }
    return merged;
}

TriMesh transformed(const TriMesh& mesh, const Pose& targetFromSource, const Vec3& scale)
{
    TriMesh moved = mesh;
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const Vec3 scaled = scale.cwiseProduct(mesh.points.col(v));
        moved.points.col(v) = targetFromSource * scaled;
    }
    return moved;
}

void turnInsideOut(TriMesh& mesh)
{
    mesh.triangles.row(1).swap(mesh.triangles.row(2));
    for (Eigen::Index corner = 0; corner < mesh.cornerUvs.cols(); corner += 3) {
        mesh.cornerUvs.col(corner + 1).swap(mesh.cornerUvs.col(corner + 2));
    }
}

double signedVolume(const TriMesh& mesh)
{
    if (mesh.triangles.cols() == 0) return 0.0;
    const Vec3 base = mesh.points.col(mesh.triangles(0, 0));
    double sum = 0.0;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto [a, b, c] = cornersOf(mesh, f).seenFrom(base);
        sum += a.dot(b.cross(c));
    }
    return sum / 6.0;
}

}  // namespace scree
