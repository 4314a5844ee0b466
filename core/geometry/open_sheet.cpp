#include "core/geometry/open_sheet.h"

#include <span>

#include "core/geometry/mesh_defects.h"

namespace scree {

std::vector<TriangleSide> rimOf(const TriMesh& sheet)
{
    std::vector<TriangleSide> rim;
    MeshEdges(sheet).forEach([&](std::span<const TriangleSide> sides) {
        if (sides.size() == 1) rim.push_back(sides[0]);
    });
    return rim;
}

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

void addWalls(const std::vector<TriangleSide>& rim, int offset,
              std::vector<std::array<int, 3>>& added)
{
    for (const TriangleSide& side : rim) {
        const int from = fromOf(side), to = toOf(side);
        added.push_back({to, from, offset + from});
        added.push_back({to, offset + from, offset + to});
    }
}

void addBack(const TriMesh& sheet, const std::vector<Eigen::Index>& triangles, int offset,
             std::vector<std::array<int, 3>>& added)
{
    for (const Eigen::Index f : triangles) {
        const auto corners = sheet.triangles.col(f);
        added.push_back({offset + corners[0], offset + corners[2], offset + corners[1]});
    }
}

TriMesh extended(const TriMesh& sheet, const Points& points,
                 const std::vector<std::array<int, 3>>& added)
{
    TriMesh all{Points(3, sheet.points.cols() + points.cols()),
                Triangles(3, sheet.triangles.cols() + static_cast<Eigen::Index>(added.size()))};
    all.points << sheet.points, points;
    all.triangles << sheet.triangles,
        Eigen::Map<const Triangles>(added.front().data(), 3,
                                    static_cast<Eigen::Index>(added.size()));
    return all;
}

}  // namespace scree
