// A triangle mesh. What may be wrong with one is in mesh_defects.h.
#pragma once

#include "core/math/types.h"

namespace scree {

/// Triangles are counter-clockwise seen from outside; lengths [m] unless a caller says otherwise.
struct TriMesh {
    Points points;             // 3×#V
    Triangles triangles;       // 3×#F
    CornerUvs cornerUvs = {};  // 2×(3·#F), or empty
};

/// Where the corners of a triangle are [m].
struct TriangleCorners {
    Vec3 a, b, c;

    TriangleCorners seenFrom(const Vec3& place) const { return {a - place, b - place, c - place}; }

    const Vec3& operator[](int k) const { return k == 0 ? a : k == 1 ? b : c; }

    /// Unit, to the side from which the corners go round anticlockwise; zero where they lie on a
    /// line.
    Vec3 normal() const { return (b - a).cross(c - a).normalized(); }
    /// The same, as long as the triangle is large [m²].
    Vec3 areaVector() const { return 0.5 * (b - a).cross(c - a); }
    Vec3 middle() const { return (a + b + c) / 3.0; }
    /// Between the edges that meet in a corner [rad].
    double angleAt(int k) const;
};

inline TriangleCorners cornersOf(const TriMesh& mesh, Eigen::Index triangle)
{
    const auto corner = [&](int k) { return mesh.points.col(mesh.triangles(k, triangle)); };
    return {corner(0), corner(1), corner(2)};
}

/// Triangles two of whose corners are one point.
enum class FlatTriangles { drop, keep };

/// Joins points that are equal bit for bit and drops points no triangle uses, and triangles that
/// lose a corner by this unless asked to keep them. Texture coordinates stay with their corners.
TriMesh mergeEqualPoints(const TriMesh& mesh, FlatTriangles flat = FlatTriangles::drop);

/// The same surface moved into another frame. `scale` is applied first, per axis, all > 0.
TriMesh transformed(const TriMesh& mesh, const Pose& targetFromSource,
                    const Vec3& scale = Vec3::Ones());

/// Turns every triangle over, its texture coordinates too: outside becomes inside.
void turnInsideOut(TriMesh& mesh);

/// Volume enclosed [m³]; positive when oriented outward.
double signedVolume(const TriMesh& mesh);

}  // namespace scree
