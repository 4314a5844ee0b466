// Why a mesh is not the boundary of a solid, by class and with the place.  [A1]
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// One class of defect: how many there are, and where the first is.
struct MeshDefect {
    std::string what;  ///< "open edge", "non-manifold edge", "zero-area triangle", …
    std::size_t count = 0;
    int triangle = -1;  ///< −1: of no triangle
    Vec3 place = Vec3::Zero();
};

/// Which defects are looked for.
enum class DefectSearch {
    all,
    topology,  ///< not whether faces pierce each other or one part lies inside another
};

/// Empty means closed, manifold, oriented outward, and that no part pierces or holds another.
/// Parts that lie in a cavity of another, or are such a cavity, are in order.
std::vector<MeshDefect> findDefects(const TriMesh& mesh, DefectSearch search = DefectSearch::all);

/// Throws Error{badInput} that names `name`, the defects with their places and what to write,
/// unless the mesh is a solid.
void requireSolid(const TriMesh& mesh, const std::string& name,
                  DefectSearch search = DefectSearch::all);

/// Throws the same where not even a surface is there: no triangles, indices or numbers that are
/// none, sizes beyond all measure.
void requireSurface(const TriMesh& mesh, const std::string& name);

/// "open edge at (0, 1, 0), triangle 3 and 11 more".
std::string describe(const MeshDefect& defect);
std::string describe(const std::vector<MeshDefect>& defects);

/// Which part of the mesh each triangle belongs to, parts joined by common points, counted from 0
/// in the order of their first triangle.
std::vector<int> findParts(const TriMesh& mesh);

}  // namespace scree
