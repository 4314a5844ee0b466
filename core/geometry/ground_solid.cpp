#include "core/geometry/ground_solid.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/mesh_edges.h"
#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kDepth = 0.1;  // of the longest edge

/// The floor is the sheet once more, as flat as that: no triangulation of its rim, whatever that
/// looks like, and no face without area or folded over another where the sheet has a cliff.
constexpr double kFlat = 1.0 / 64.0;

/// Less of all area than that looks to no side: what is left of a tube, or of a ball with a hole.
constexpr double kLeastFacing = 0.05;

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
    throw Error(ErrorKind::badInput, "shape '" + name + "' makes no ground: " + why);
}

/// The axis that is nearest to where the faces look.
Vec3 axisOf(const TriMesh& sheet, const std::vector<Eigen::Index>& open, const std::string& name)
{
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const Eigen::Index f : open) {
        const Vec3 ofFace = cornersOf(sheet, f).areaVector();
        sum += ofFace;
        area += ofFace.norm();
    }
    if (!(sum.norm() > kLeastFacing * area)) refuse(name, "its faces look to all sides alike");
    Eigen::Index axis;
    sum.cwiseAbs().maxCoeff(&axis);
    return sum[axis] > 0.0 ? Vec3(Vec3::Unit(axis)) : Vec3(-Vec3::Unit(axis));
}

/// The sides of triangles at which nothing goes on.
std::vector<TriangleSide> rimOf(const TriMesh& sheet)
{
    std::vector<TriangleSide> rim;
    MeshEdges(sheet).forEach([&](std::span<const TriangleSide> sides) {
        if (sides.size() == 1) rim.push_back(sides[0]);
    });
    return rim;
}

/// The triangles of parts that have a rim.
std::vector<Eigen::Index> openTriangles(const TriMesh& sheet, const std::vector<TriangleSide>& rim)
{
    const std::vector<int> partOf = findParts(sheet);
    std::vector<char> isOpen(partOf.size(), 0);
    for (const TriangleSide& side : rim) isOpen[partOf[side.triangle]] = 1;
    std::vector<Eigen::Index> open;
    for (Eigen::Index f = 0; f < sheet.triangles.cols(); ++f) {
        if (isOpen[partOf[f]]) open.push_back(f);
    }
    return open;
}

Aabb boxOf(const TriMesh& sheet, const std::vector<Eigen::Index>& triangles)
{
    Aabb box;
    for (const Eigen::Index f : triangles) {
        for (const int corner : sheet.triangles.col(f)) box.include(sheet.points.col(corner));
    }
    return box;
}

/// Where the points of the sheet have their like on the floor.
Points floorBelow(const TriMesh& sheet, const Aabb& box, const Vec3& up, double depth)
{
    const double lowest = std::min(up.dot(box.min), up.dot(box.max));
    const double highest = std::max(up.dot(box.min), up.dot(box.max));
    const Eigen::RowVectorXd heights = up.transpose() * sheet.points;
    const Eigen::RowVectorXd onFloor =
        (lowest - depth + kFlat * (heights.array() - highest)).matrix();
    return sheet.points + up * (onFloor - heights);
}

}  // namespace

GroundSolid closeBelow(const TriMesh& sheet, double depth, const std::string& name)
{
    const std::vector<TriangleSide> rim = rimOf(sheet);
    if (rim.empty())
        refuse(name, "it has no rim, so there is nothing to close; leave 'repair' out");
    const std::vector<Eigen::Index> open = openTriangles(sheet, rim);
    const Aabb box = boxOf(sheet, open);
    GroundSolid ground;
    ground.up = axisOf(sheet, open, name);
    ground.depth = depth > 0.0 ? depth : kDepth * box.longestEdge();

    const auto points = static_cast<int>(sheet.points.cols());
    TriMesh all{Points(3, 2 * points),
                Triangles(3, sheet.triangles.cols() +
                                 static_cast<Eigen::Index>(open.size() + 2 * rim.size()))};
    all.points << sheet.points, floorBelow(sheet, box, ground.up, ground.depth);
    all.triangles.leftCols(sheet.triangles.cols()) = sheet.triangles;
    Eigen::Index next = sheet.triangles.cols();
    for (const Eigen::Index f : open) {
        const auto corners = sheet.triangles.col(f);
        all.triangles.col(next++) << points + corners[0], points + corners[2], points + corners[1];
    }
    for (const TriangleSide& side : rim) {
        const int from = side.isUp ? side.low : side.high, to = side.isUp ? side.high : side.low;
        all.triangles.col(next++) << to, from, points + from;
        all.triangles.col(next++) << to, points + from, points + to;
    }
    ground.mesh = mergeEqualPoints(all);

    const std::vector<MeshDefect> defects = findDefects(ground.mesh);
    if (!defects.empty()) {
        refuse(name, "closed below, it is no solid: " + describe(defects) +
                         "; mend the sheet there, or write mesh = { repair = \"shell\", thickness "
                         "= … }");
    }
    return ground;
}

}  // namespace scree
