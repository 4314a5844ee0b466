#include "core/geometry/tri_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "core/base/error.h"

namespace scree {
namespace {

std::string placeText(const Vec3& p)
{
    char text[96];
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
    return text;
}

struct EdgeUse {
    int forward = 0, backward = 0;  // how often a triangle walks it low→high and high→low
    int triangle = -1;
};

}  // namespace

TriMesh mergeEqualPoints(const TriMesh& mesh)
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
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
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
        const Vec3 a = mesh.points.col(mesh.triangles(0, f)) - base;
        const Vec3 b = mesh.points.col(mesh.triangles(1, f)) - base;
        const Vec3 c = mesh.points.col(mesh.triangles(2, f)) - base;
        sum += a.dot(b.cross(c));
    }
    return sum / 6.0;
}

std::vector<MeshDefect> findDefects(const TriMesh& mesh, std::size_t most)
{
    std::vector<MeshDefect> defects;
    const auto report = [&](const std::string& what, int triangle, const Vec3& place) {
        if (defects.size() < most) defects.push_back({what, triangle, place});
    };

    if (mesh.triangles.cols() == 0) {
        report("no triangles", -1, Vec3::Zero());
        return defects;
    }
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        if (!mesh.points.col(v).allFinite()) {
            report("point that is not a number", -1, Vec3::Zero());
            return defects;
        }
    }
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto corners = mesh.triangles.col(f);
        if (corners.minCoeff() < 0 || corners.maxCoeff() >= mesh.points.cols()) {
            report("triangle with a corner that does not exist", static_cast<int>(f), Vec3::Zero());
            return defects;
        }
    }

    // Every edge must be walked once in each direction.
    std::map<std::pair<int, int>, EdgeUse> edges;
    for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
        const Vec3 a = mesh.points.col(mesh.triangles(0, f));
        const Vec3 b = mesh.points.col(mesh.triangles(1, f));
        const Vec3 c = mesh.points.col(mesh.triangles(2, f));
        if (!((b - a).cross(c - a).norm() > 0.0)) report("zero-area triangle", f, a);
        for (int k = 0; k < 3; ++k) {
            const int from = mesh.triangles(k, f), to = mesh.triangles((k + 1) % 3, f);
            EdgeUse& use = edges[std::minmax(from, to)];
            (from < to ? use.forward : use.backward) += 1;
            use.triangle = f;
        }
    }
    for (const auto& [ends, use] : edges) {
        const Vec3 middle = 0.5 * (mesh.points.col(ends.first) + mesh.points.col(ends.second));
        if (use.forward + use.backward == 1) {
            report("open edge", use.triangle, middle);
        } else if (use.forward + use.backward > 2) {
            report("non-manifold edge", use.triangle, middle);
        } else if (use.forward != use.backward) {
            report("edge whose two faces are oriented against each other", use.triangle, middle);
        }
    }
    if (defects.empty() && !(signedVolume(mesh) > 0.0)) {
        const Vec3 place = mesh.points.col(mesh.triangles(0, 0));
        report("inside-out or empty: the signed volume is not positive", 0, place);
    }
    return defects;
}

void requireSolid(const TriMesh& mesh, const std::string& name)
{
    const std::vector<MeshDefect> defects = findDefects(mesh);
    if (defects.empty()) return;
    std::string text = "shape '" + name + "' is not a closed, outward-oriented solid:";
    for (const MeshDefect& defect : defects) {
        text += " " + defect.what;
        if (defect.triangle >= 0) {
            text +=
                " at " + placeText(defect.place) + ", triangle " + std::to_string(defect.triangle);
        }
        text += ";";
    }
    text.pop_back();
    throw Error(ErrorKind::badInput, text);
}

}  // namespace scree
