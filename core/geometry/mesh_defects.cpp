#include "core/geometry/mesh_defects.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/geometry/mesh_crossings.h"
#include "core/geometry/mesh_edges.h"
#include "core/geometry/winding_number.h"
#include "core/math/point_box.h"

namespace scree {
namespace {

/// Gathers defects by class, in the order in which the classes are first met.
class DefectList {
public:
    void add(const std::string& what, int triangle, const Vec3& place)
    {
        for (MeshDefect& defect : defects_) {
            if (defect.what != what) continue;
            ++defect.count;
            return;
        }
        defects_.push_back({what, 1, triangle, place});
    }

    bool isEmpty() const { return defects_.empty(); }
    std::vector<MeshDefect> take() { return std::move(defects_); }

private:
    std::vector<MeshDefect> defects_;
};

/// Defects of the numbers themselves: nothing else can be said of a mesh that has them.
void findBrokenNumbers(const TriMesh& mesh, DefectList& defects)
{
    if (mesh.triangles.cols() == 0) defects.add("no triangles", -1, Vec3::Zero());
    for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
        const auto corners = mesh.triangles.col(f);
        if (corners.minCoeff() < 0 || corners.maxCoeff() >= mesh.points.cols()) {
            defects.add("triangle with a corner that does not exist", f, Vec3::Zero());
        }
    }
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        if (!mesh.points.col(v).allFinite()) {
            defects.add("point that is not a number", -1, Vec3::Zero());
        }
    }
    // Volumes are cubes of lengths and inertia their fifth power: beyond these nothing holds.
    constexpr double kLargest = 1e9, kSmallest = 1e-9;
    if (!defects.isEmpty()) return;
    const double extent = boxOf(mesh.points).longestEdge();
    const double farthest = mesh.points.cwiseAbs().maxCoeff();
    const Vec3 place = mesh.points.col(mesh.triangles(0, 0));
    if (farthest > kLargest) defects.add("point farther than 1e9 m from the origin", 0, place);
    if (extent < kSmallest) defects.add("size of less than 1e-9 m", 0, place);
}

/// Every edge must be walked once in each direction.
void findBadEdges(const TriMesh& mesh, DefectList& defects)
{
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        const TriangleSide& last = sides.back();
        const Vec3 middle = 0.5 * (mesh.points.col(last.low) + mesh.points.col(last.high));
        if (sides.size() == 1) {
            defects.add("open edge", last.triangle, middle);
        } else if (sides.size() > 2) {
            defects.add("non-manifold edge", last.triangle, middle);
        } else if (sides[0].isUp == sides[1].isUp) {
            defects.add("edge whose two faces are oriented against each other", last.triangle,
                        middle);
        }
    });
}

void findFlatTriangles(const TriMesh& mesh, DefectList& defects)
{
    for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        if (!(corners.areaVector().norm() > 0.0)) defects.add("zero-area triangle", f, corners.a);
    }
}

/// With points of its own alone: with all of them for each of a thousand parts a check took
/// minutes.
TriMesh partOfMesh(const TriMesh& mesh, const std::vector<int>& triangles)
{
    TriMesh part{Points(3, 3 * triangles.size()), Triangles(3, triangles.size())};
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const int corner = static_cast<int>(3 * i) + k;
            part.points.col(corner) = mesh.points.col(mesh.triangles(k, triangles[i]));
            part.triangles(k, i) = corner;
        }
    }
    return part;
}

/// A part stands free or in a cavity, where the others wind around it 0 times; a part that is a
/// cavity lies where they wind once. Some triangles of it are asked: of two boxes that overlap with
/// flush faces hardly an edge goes through a face. On what merely touches they wind half.
void findMisplacedParts(const TriMesh& mesh, DefectList& defects)
{
    constexpr std::size_t kAsked = 16;
    constexpr double kClearly = 0.75;
    const std::vector<int> partOf = findParts(mesh);
    std::vector<std::vector<int>> trianglesOf(1 + *std::max_element(partOf.begin(), partOf.end()));
    if (trianglesOf.size() == 1) return;
    for (int f = 0; f < static_cast<int>(partOf.size()); ++f) trianglesOf[partOf[f]].push_back(f);
    const WindingNumber whole(mesh);
    for (const std::vector<int>& triangles : trianglesOf) {
        const TriMesh alone = partOfMesh(mesh, triangles);
        const WindingNumber own(alone);
        const double wanted = signedVolume(alone) > 0.0 ? 0.0 : 1.0;
        const std::size_t step = (triangles.size() + kAsked - 1) / kAsked;
        for (std::size_t i = 0; i < triangles.size(); i += step) {
            const Vec3 place = cornersOf(mesh, triangles[i]).middle();
            if (std::abs(whole.at(place) - own.at(place) - wanted) < kClearly) continue;
            defects.add(
                wanted == 1.0 ? "part that is turned inside-out" : "part that lies inside another",
                triangles[i], place);
            break;
        }
    }
}

}  // namespace

std::vector<MeshDefect> findDefects(const TriMesh& mesh, DefectSearch search)
{
    DefectList defects;
    findBrokenNumbers(mesh, defects);
    if (!defects.isEmpty()) return defects.take();
    findFlatTriangles(mesh, defects);
    findBadEdges(mesh, defects);
    if (search == DefectSearch::all) {
        for (const MeshCrossing& crossing : findCrossings(mesh)) {
            defects.add("face that pierces another", crossing.triangle, crossing.place);
        }
    }
    if (!defects.isEmpty()) return defects.take();
    if (!(signedVolume(mesh) > 0.0)) {
        const Vec3 place = mesh.points.col(mesh.triangles(0, 0));
        defects.add("inside-out or empty: the signed volume is not positive", 0, place);
    } else if (search == DefectSearch::all) {
        findMisplacedParts(mesh, defects);
    }
    return defects.take();
}

void requireSolid(const TriMesh& mesh, const std::string& name, DefectSearch search)
{
    requireSurface(mesh, name);
    const std::vector<MeshDefect> defects = findDefects(mesh, search);
    if (defects.empty()) return;
    throw Error(ErrorKind::badInput,
                "shape '" + name +
                    "' is not a closed, outward-oriented solid: " + describe(defects) +
                    "; mend the mesh, or write mesh = { repair = \"wrap\" } to collide as the "
                    "solid it nearly bounds, mesh = { repair = \"shell\", thickness = … } to give "
                    "its sheets a thickness, mesh = { repair = \"ground\" } to close a terrain "
                    "below, or mesh = { repair = \"solidify\", thickness = … } to back the floor "
                    "and walls of a stage");
}

void requireSurface(const TriMesh& mesh, const std::string& name)
{
    DefectList defects;
    findBrokenNumbers(mesh, defects);
    if (defects.isEmpty()) return;
    throw Error(ErrorKind::badInput,
                "shape '" + name + "' is no surface: " + describe(defects.take()));
}

std::string describe(const std::vector<MeshDefect>& defects)
{
    std::string text;
    for (const MeshDefect& defect : defects) text += (text.empty() ? "" : "; ") + describe(defect);
    return text;
}

std::string describe(const MeshDefect& defect)
{
    if (defect.triangle < 0) return defect.what;
    char place[128];
    std::snprintf(place, sizeof place, " at (%.6g, %.6g, %.6g), triangle %d", defect.place.x(),
                  defect.place.y(), defect.place.z(), defect.triangle);
    return defect.what + place +
           (defect.count > 1 ? " and " + std::to_string(defect.count - 1) + " more" : "");
}

std::vector<int> findParts(const TriMesh& mesh)
{
    DisjointSets parts(mesh.points.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 1; k < 3; ++k) parts.join(mesh.triangles(0, f), mesh.triangles(k, f));
    }
    std::map<std::size_t, int> numberOf;
    std::vector<int> partOf;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const int next = static_cast<int>(numberOf.size());
        partOf.push_back(
            numberOf.try_emplace(parts.find(mesh.triangles(0, f)), next).first->second);
    }
    return partOf;
}

}  // namespace scree
