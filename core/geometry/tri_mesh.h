// A triangle mesh and what can be said of its fitness to be a solid.  [A1]
#pragma once

#include <string>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// Triangles are counter-clockwise seen from outside; lengths [m] unless a caller says otherwise.
struct TriMesh {
    Points points;             // 3×#V
    Triangles triangles;       // 3×#F
    CornerUvs cornerUvs = {};  // 2×(3·#F), or empty
};

/// Why a mesh is not the boundary of a solid; the first defects found, each with its place.
struct MeshDefect {
    std::string what;  ///< "open edge", "non-manifold edge", "zero-area triangle", …
    int triangle = -1;
    Vec3 place = Vec3::Zero();
};

/// Joins points that are equal bit for bit and drops points no triangle uses. Triangles that lose a
/// corner by this are dropped too. Texture coordinates stay with their corners.
TriMesh mergeEqualPoints(const TriMesh& mesh);

/// The same surface moved into another frame. `scale` is applied first, per axis, all > 0.
TriMesh transformed(const TriMesh& mesh, const Pose& targetFromSource,
                    const Vec3& scale = Vec3::Ones());

/// Turns every triangle over, its texture coordinates too: outside becomes inside.
void turnInsideOut(TriMesh& mesh);

/// At most `most` defects; empty means closed, manifold, consistently oriented outward.
std::vector<MeshDefect> findDefects(const TriMesh& mesh, std::size_t most = 5);

/// Throws Error{badInput} that names `name`, the defects and their places unless the mesh is a
/// solid.
void requireSolid(const TriMesh& mesh, const std::string& name);

/// Six times the signed volume is the sum of these determinants; positive when oriented outward.
double signedVolume(const TriMesh& mesh);

}  // namespace scree
