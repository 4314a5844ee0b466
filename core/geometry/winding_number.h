// How often a surface winds around a point: 1 inside a closed mesh, 0 outside, and something in
// between near the holes of an open one. It says what is inside where a mesh has no inside.
//
// Far triangles count as one flux through their common centre ([BDS18], first order), near ones
// by their exact solid angle.
#pragma once

#include <vector>

#include "core/geometry/tri_mesh.h"

namespace scree {

class WindingNumber {
public:
    explicit WindingNumber(const TriMesh& mesh);

    /// Off by less than 0.03, near the surface by far less.
    double at(const Vec3& point) const;

private:
    struct Node {
        Vec3 centre = Vec3::Zero();  // of the triangles, by area
        Vec3 flux = Vec3::Zero();    // sum of their area vectors
        double radius = 0.0;         // around centre, of all their corners
        int begin = 0, end = 0;      // range of order_
        int left = -1, right = -1;   // −1: a leaf
    };

    class AngleSum;

    int build(int begin, int end);
    void addSolidAngle(int triangle, const Vec3& point, AngleSum& sum) const;

    TriMesh mesh_;
    Points centroids_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace scree
