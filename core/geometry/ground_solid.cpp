#include "core/geometry/ground_solid.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/mesh_edges.h"
#include "core/geometry/mesh_repair.h"
#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kDepth = 0.1;  // of the longest edge

/// Where the rim is no simple outline the floor is the sheet once more, as flat as that: whatever
/// it looks like, no face of the floor lies on another or has no area where the sheet has a cliff.
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

// The way a triangle walks its side.
int fromOf(const TriangleSide& side)
{
    return side.isUp ? side.low : side.high;
}
int toOf(const TriangleSide& side)
{
    return side.isUp ? side.high : side.low;
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

Vec3 middleOf(const TriMesh& sheet, const std::vector<TriangleSide>& rim)
{
    Vec3 sum = Vec3::Zero();
    for (const TriangleSide& side : rim) sum += sheet.points.col(fromOf(side));
    return sum / static_cast<double>(rim.size());
}

/// Whether all of the rim is seen from its middle without looking past any of it: so it is in
/// nearly all terrain, and a fan of triangles is floor enough.
bool isOutlineAround(const Vec3& middle, const TriMesh& sheet, const std::vector<TriangleSide>& rim,
                     const Vec3& up)
{
    return std::ranges::all_of(rim, [&](const TriangleSide& side) {
        const Vec3 from = sheet.points.col(fromOf(side)) - middle;
        const Vec3 to = sheet.points.col(toOf(side)) - middle;
        return up.dot(from.cross(to)) > 0.0;
    });
}

/// Where the points of the sheet have their like on the floor, of which the highest is at `top`.
Points onFloor(const Points& points, const Vec3& up, double highest, double top)
{
    const Eigen::RowVectorXd heights = up.transpose() * points;
    const Eigen::RowVectorXd below = (top + kFlat * (heights.array() - highest)).matrix();
    return points + up * (below - heights);
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

    const Vec3& up = ground.up;
    const double lowest = std::min(up.dot(box.min), up.dot(box.max));
    const double highest = std::max(up.dot(box.min), up.dot(box.max));
    const double top = lowest - ground.depth;
    const Vec3 middle = middleOf(sheet, rim);
    const bool isFan = isOutlineAround(middle, sheet, rim, up);
    const auto points = static_cast<int>(sheet.points.cols());
    std::vector<std::array<int, 3>> added;
    for (const TriangleSide& side : rim) {
        const int from = fromOf(side), to = toOf(side);
        added.push_back({to, from, points + from});
        added.push_back({to, points + from, points + to});
        if (isFan) added.push_back({2 * points, points + to, points + from});
    }
    if (!isFan) {
        for (const Eigen::Index f : open) {
            const auto corners = sheet.triangles.col(f);
            added.push_back({points + corners[0], points + corners[2], points + corners[1]});
        }
    }
    TriMesh all{Points(3, 2 * points + 1),
                Triangles(3, sheet.triangles.cols() + static_cast<Eigen::Index>(added.size()))};
    all.points << sheet.points, onFloor(sheet.points, up, highest, top),
        onFloor(middle + up * (lowest - up.dot(middle)), up, highest, top);
    all.triangles << sheet.triangles,
        Eigen::Map<const Triangles>(added.front().data(), 3,
                                    static_cast<Eigen::Index>(added.size()));
    HarmlessRepairs ignored;  // of walls below a rim that goes straight up
    ground.mesh = repairHarmlessly(all, ignored);

    const std::vector<MeshDefect> defects = findDefects(ground.mesh);
    if (!defects.empty()) {
        refuse(name, "closed below, it is no solid: " + describe(defects) +
                         "; mend the sheet there, or write mesh = { repair = \"shell\", thickness "
                         "= … }");
    }
    return ground;
}

}  // namespace scree
