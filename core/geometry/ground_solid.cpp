#include "core/geometry/ground_solid.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/mesh_repair.h"
#include "core/geometry/open_sheet.h"
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
    addWalls(rim, points, added);
    if (isFan) {
        for (const TriangleSide& side : rim)
            added.push_back({2 * points, points + toOf(side), points + fromOf(side)});
    } else {
        addBack(sheet, open, points, added);
    }
    Points below(3, points + 1);
    below << onFloor(sheet.points, up, highest, top),
        onFloor(middle + up * (lowest - up.dot(middle)), up, highest, top);
    const TriMesh all = extended(sheet, below, added);
    HarmlessRepairs ignored;  // of walls below a rim that goes straight up
    ground.mesh = repairHarmlessly(all, ignored);

    const std::vector<MeshDefect> defects = findDefects(ground.mesh);
    if (!defects.empty()) {
        refuse(name, "closed below, it is no solid: " + describe(defects) +
                         "; mend the sheet there, or write mesh = { repair = \"solidify\", "
                         "thickness = … }");
    }
    return ground;
}

}  // namespace scree
