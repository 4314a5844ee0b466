// The rim of a mesh that is not closed, and which of its parts have one.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/mesh_edges.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// The ends of a side, the way its triangle walks it.
inline int fromOf(const TriangleSide& side)
{
    return side.isUp ? side.low : side.high;
}
inline int toOf(const TriangleSide& side)
{
    return side.isUp ? side.high : side.low;
}

/// The sides of triangles at which nothing goes on.
std::vector<TriangleSide> rimOf(const TriMesh& sheet);

/// The triangles of parts that have a rim; closed parts are solids already.
std::vector<Eigen::Index> openTriangles(const TriMesh& sheet, const std::vector<TriangleSide>& rim);

/// Triangles from the rim to the like of the sheet's points that follow `offset` later.
void addWalls(const std::vector<TriangleSide>& rim, int offset,
              std::vector<std::array<int, 3>>& added);

/// The triangles named, of points that follow `offset` later, seen from the other side.
void addBack(const TriMesh& sheet, const std::vector<Eigen::Index>& triangles, int offset,
             std::vector<std::array<int, 3>>& added);

/// The sheet, more points behind its own, and more triangles.
TriMesh extended(const TriMesh& sheet, const Points& points,
                 const std::vector<std::array<int, 3>>& added);

}  // namespace scree
