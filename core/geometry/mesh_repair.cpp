#include "core/geometry/mesh_repair.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace scree {
namespace {

using Edge = std::pair<int, int>;  // as a triangle walks it

bool isReadable(const TriMesh& mesh)
{
    return mesh.triangles.cols() > 0 && mesh.points.allFinite() && mesh.triangles.minCoeff() >= 0 &&
           mesh.triangles.maxCoeff() < mesh.points.cols();
}

/// Whether a triangle has no height but by rounding of its corners, which files keep in single
/// precision: its normal is noise. One beside a T-junction made a ball of 1280 triangles an edged
/// body with blades.
bool isFlat(const TriMesh& mesh, int a, int b, int c)
{
    constexpr double kRounding = 1e-6;  // of its longest side
    const Vec3 p = mesh.points.col(a), q = mesh.points.col(b), r = mesh.points.col(c);
    const double longest =
        std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
    return !((q - p).cross(r - p).norm() > kRounding * longest);
}

/// Which triangle walks each edge; false when some edge is walked twice.
bool mapEdges(const TriMesh& mesh, std::map<Edge, int>& walkers)
{
    walkers.clear();
    for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
        for (int k = 0; k < 3; ++k) {
            const Edge edge(mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f));
            if (!walkers.emplace(edge, f).second) return false;
        }
    }
    return true;
}

/// A triangle a b c with b between a and c, and its neighbour c a d, cover what a b d and b c d do.
bool flipLongEdge(TriMesh& mesh, int triangle, std::map<Edge, int>& walkers)
{
    int k = 0;
    double longest = -1.0;
    for (int i = 0; i < 3; ++i) {
        const Vec3 from = mesh.points.col(mesh.triangles(i, triangle));
        const Vec3 to = mesh.points.col(mesh.triangles((i + 1) % 3, triangle));
        if ((to - from).norm() <= longest) continue;
        longest = (to - from).norm();
        k = i;
    }
    const int c = mesh.triangles(k, triangle), a = mesh.triangles((k + 1) % 3, triangle);
    const int b = mesh.triangles((k + 2) % 3, triangle);
    const auto across = walkers.find({a, c});
    if (across == walkers.end()) return false;
    const int neighbour = across->second;
    int d = -1;
    for (int i = 0; i < 3; ++i) {
        const int corner = mesh.triangles(i, neighbour);
        if (corner != a && corner != c) d = corner;
    }
    const bool isTaken = walkers.contains({b, d}) || walkers.contains({d, b});
    if (d == b || isTaken || isFlat(mesh, a, b, d) || isFlat(mesh, b, c, d)) return false;
    // The neighbour walked a → c → d; together they now walk a → b → c → d round.
    mesh.triangles.col(triangle) << a, b, d;
    mesh.triangles.col(neighbour) << b, c, d;
    walkers.erase({a, c});
    walkers.erase({c, a});
    walkers[{b, d}] = walkers[{d, a}] = triangle;
    walkers[{d, b}] = walkers[{b, c}] = neighbour;
    return true;
}

int flipFlatTriangles(TriMesh& mesh)
{
    std::vector<int> flat;
    for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
        if (isFlat(mesh, mesh.triangles(0, f), mesh.triangles(1, f), mesh.triangles(2, f)))
            flat.push_back(f);
    }
    std::map<Edge, int> walkers;
    if (flat.empty() || !mapEdges(mesh, walkers)) return 0;
    // Of two flat ones in a row the outer one may have to go first, whichever comes first.
    int flips = 0;
    for (std::size_t before = 0; before != flat.size();) {
        before = flat.size();
        std::erase_if(flat, [&](int f) { return flipLongEdge(mesh, f, walkers); });
        flips += static_cast<int>(before - flat.size());
    }
    return flips;
}

bool isClosed(const TriMesh& mesh)
{
    std::map<Edge, int> walkers;
    if (!mapEdges(mesh, walkers)) return false;
    for (const auto& [edge, triangle] : walkers) {
        if (!walkers.contains({edge.second, edge.first})) return false;
    }
    return true;
}

}  // namespace

TriMesh repairHarmlessly(const TriMesh& mesh, HarmlessRepairs& repairs)
{
    repairs = {};
    if (!isReadable(mesh)) return mesh;
    TriMesh repaired = mergeEqualPoints(mesh);
    repairs.mergedPoints = static_cast<int>(mesh.points.cols() - repaired.points.cols());
    repairs.droppedTriangles = static_cast<int>(mesh.triangles.cols() - repaired.triangles.cols());
    repairs.flippedEdges = flipFlatTriangles(repaired);
    if (signedVolume(repaired) < 0.0 && isClosed(repaired)) {
        turnInsideOut(repaired);
        repairs.isTurned = true;
    }
    return repaired;
}

std::string describe(const HarmlessRepairs& repairs)
{
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    if (repairs.mergedPoints > 0) {
        add("merged " + std::to_string(repairs.mergedPoints) + " equal or unused points");
    }
    if (repairs.droppedTriangles > 0) {
        add("dropped " + std::to_string(repairs.droppedTriangles) + " triangles without area");
    }
    if (repairs.flippedEdges > 0) {
        add("flipped " + std::to_string(repairs.flippedEdges) + " edges of flat triangles");
    }
    if (repairs.isTurned) add("turned the mesh, which was inside-out");
    return text;
}

}  // namespace scree
