// Closest point of a triangle, and which of its features (face, edges, corners) holds it.
#pragma once

#include "core/math/types.h"

namespace scree {

/// 0, 1, 2: corner a, b, c; 3, 4, 5: edge ab, bc, ca; 6: the face.
enum class TriangleFeature : int { a, b, c, ab, bc, ca, face };

struct ClosestOnTriangle {
    Vec3 point;
    TriangleFeature feature;
};

/// By Voronoi regions of the triangle; degenerate triangles answer with a corner or an edge.
inline ClosestOnTriangle closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                           const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double abAp = ab.dot(ap), acAp = ac.dot(ap);
    if (abAp <= 0.0 && acAp <= 0.0) return {a, TriangleFeature::a};

    const Vec3 bp = p - b;
    const double abBp = ab.dot(bp), acBp = ac.dot(bp);
    if (abBp >= 0.0 && acBp <= abBp) return {b, TriangleFeature::b};

    const Vec3 cp = p - c;
    const double abCp = ab.dot(cp), acCp = ac.dot(cp);
    if (acCp >= 0.0 && abCp <= acCp) return {c, TriangleFeature::c};

    // Signed areas opposite each corner; not positive means beyond that edge.
    const double areaC = abAp * acBp - abBp * acAp;
    if (areaC <= 0.0 && abAp >= 0.0 && abBp <= 0.0) {
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

}  // namespace scree
