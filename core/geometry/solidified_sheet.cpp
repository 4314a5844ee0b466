#include "core/geometry/solidified_sheet.h"

#include <Eigen/Eigenvalues>

#include <array>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/mesh_repair.h"
#include "core/geometry/open_sheet.h"

namespace scree {
namespace {

/// Of the largest eigenvalue of the sum of n nᵀ: along an axis with less than this the faces around
/// a point say nothing. So it is where two planes turn by 16° or less, in a sheet that is smooth.
constexpr double kTold = 0.02;

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
    throw Error(ErrorKind::badInput, "shape '" + name + "' cannot be solidified: " + why);
}

/// What the faces around a point say about where its like behind them is.
struct PointPlanes {
    Mat3 squares =
        Mat3::Zero();         ///< Σ w n nᵀ, of unit normals n; w grows with a face's angle there
    Vec3 sum = Vec3::Zero();  ///< Σ w n
};

/// The shortest way that goes as far behind each of the planes as can be: where they meet in an
/// edge or a corner that is straight on, so that behind plane faces there are plane faces.
Vec3 wayBehind(const PointPlanes& planes, double thickness)
{
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(planes.squares);
    const Vec3& values = solver.eigenvalues();
    Vec3 way = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        if (!(values[i] > kTold * values[2])) continue;
        const Vec3 axis = solver.eigenvectors().col(i);
        way -= thickness * axis.dot(planes.sum) / values[i] * axis;
    }
    return way;
}

/// The points of the sheet, and their like behind the triangles named.
Points pointsBehind(const TriMesh& sheet, const std::vector<Eigen::Index>& triangles,
                    double thickness)
{
    std::vector<PointPlanes> planes(static_cast<std::size_t>(sheet.points.cols()));
    for (const Eigen::Index f : triangles) {
        const Vec3 area = cornersOf(sheet, f).areaVector();
        if (!(area.norm() > 0.0)) continue;
        const Vec3 normal = area.normalized();
        for (int k = 0; k < 3; ++k) {
            const Vec3 at = sheet.points.col(sheet.triangles(k, f));
            const Vec3 on = sheet.points.col(sheet.triangles((k + 1) % 3, f)) - at;
            const Vec3 back = sheet.points.col(sheet.triangles((k + 2) % 3, f)) - at;
            const double weight = 1.0 - on.normalized().dot(back.normalized());
            PointPlanes& planesThere = planes[sheet.triangles(k, f)];
            planesThere.squares += weight * normal * normal.transpose();
            planesThere.sum += weight * normal;
        }
    }
    Points behind = sheet.points;
    for (std::size_t i = 0; i < planes.size(); ++i)
        behind.col(static_cast<Eigen::Index>(i)) += wayBehind(planes[i], thickness);
    return behind;
}

/// Where the sheet bends around less room than the thickness takes its back is turned over.
void requireRoomBehind(const TriMesh& sheet, const std::vector<Eigen::Index>& triangles,
                       const Points& behind, const std::string& name)
{
    const TriMesh back{behind, sheet.triangles};
    MeshDefect folded{"no room behind the face", 0, -1, Vec3::Zero()};
    for (const Eigen::Index f : triangles) {
        const TriangleCorners front = cornersOf(sheet, f);
        if (cornersOf(back, f).areaVector().dot(front.areaVector()) > 0.0) continue;
        if (folded.count++ > 0) continue;
        folded.triangle = static_cast<int>(f);
        folded.place = front.middle();
    }
    if (folded.count > 0) refuse(name, describe(folded) + "; try less thickness");
}

}  // namespace

TriMesh solidify(const TriMesh& sheet, double thickness, const std::string& name)
{
    const std::vector<TriangleSide> rim = rimOf(sheet);
    if (rim.empty())
        refuse(name, "it has no rim, so there is nothing to put behind it; leave 'repair' out");
    const std::vector<Eigen::Index> open = openTriangles(sheet, rim);
    const auto points = static_cast<int>(sheet.points.cols());
    std::vector<std::array<int, 3>> added;
    addWalls(rim, points, added);
    addBack(sheet, open, points, added);
    const Points behind = pointsBehind(sheet, open, thickness);
    requireRoomBehind(sheet, open, behind, name);
    HarmlessRepairs ignored;  // of points of parts that are closed
    const TriMesh solid = repairHarmlessly(extended(sheet, behind, added), ignored);

    const std::vector<MeshDefect> defects = findDefects(solid);
    if (!defects.empty()) {
        refuse(name, "with its back, it is no solid: " + describe(defects) +
                         "; try less thickness, mend the sheet there, or write mesh = { repair = "
                         "\"shell\", thickness = … }");
    }
    return solid;
}

}  // namespace scree
