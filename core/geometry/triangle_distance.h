// Closest point of a triangle, and which of its features (face, edges, corners) holds it.
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree {

/// 0, 1, 2: corner a, b, c; 3, 4, 5: edge ab, bc, ca; 6: the face.
enum class TriangleFeature : int { a, b, c, ab, bc, ca, face };

struct ClosestOnTriangle {
    Vec3 point;
    TriangleFeature feature;
};

/// What of a triangle's edges from its first corner does not depend on the point. [m²]
struct EdgeProducts {
    double abAb = 0.0, abAc = 0.0, acAc = 0.0;
};

inline EdgeProducts edgeProducts(const TriangleCorners& of)
{
    const Vec3 ab = of.b - of.a, ac = of.c - of.a;
    return {ab.squaredNorm(), ab.dot(ac), ac.squaredNorm()};
}

/// By Voronoi regions of the triangle; degenerate triangles answer with a corner or an edge.
inline ClosestOnTriangle closestOnTriangle(const Vec3& p, const TriangleCorners& corners,
                                           const EdgeProducts& edges)
{
    const auto& [a, b, c] = corners;
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double abAp = ab.dot(ap), acAp = ac.dot(ap);
    if (abAp <= 0.0 && acAp <= 0.0) return {a, TriangleFeature::a};

    const double abBp = abAp - edges.abAb, acBp = acAp - edges.abAc;
    if (abBp >= 0.0 && acBp <= abBp) return {b, TriangleFeature::b};

    const double abCp = abAp - edges.abAc, acCp = acAp - edges.acAc;
    if (acCp >= 0.0 && abCp <= acCp) return {c, TriangleFeature::c};

    // Signed areas opposite each corner; not positive means beyond that edge.
    const double areaC = abAp * acBp - abBp * acAp;
    if (areaC <= 0.0 && abAp >= 0.0 && abBp < 0.0) {
        return {a + abAp / (abAp - abBp) * ab, TriangleFeature::ab};
    }
    const double areaB = abCp * acAp - abAp * acCp;
    if (areaB <= 0.0 && acAp >= 0.0 && acCp <= 0.0) {
        return {a + acAp / (acAp - acCp) * ac, TriangleFeature::ca};
    }
    const double areaA = abBp * acCp - abCp * acBp;
    const double alongBc = acBp - abBp, backFromC = abCp - acCp;
    if (areaA <= 0.0 && alongBc >= 0.0 && backFromC >= 0.0) {
        return {b + alongBc / (alongBc + backFromC) * (c - b), TriangleFeature::bc};
    }
    const double inverseArea = 1.0 / (areaA + areaB + areaC);
    return {a + areaB * inverseArea * ab + areaC * inverseArea * ac, TriangleFeature::face};
}

inline ClosestOnTriangle closestOnTriangle(const Vec3& p, const TriangleCorners& corners)
{
    return closestOnTriangle(p, corners, edgeProducts(corners));
}

}  // namespace scree
