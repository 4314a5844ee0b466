// Two meshes as one.
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree::test {

inline TriMesh both(const TriMesh& a, const TriMesh& b)
{
    TriMesh mesh{Points(3, a.points.cols() + b.points.cols()),
                 Triangles(3, a.triangles.cols() + b.triangles.cols())};
    mesh.points << a.points, b.points;
    mesh.triangles << a.triangles,
        (b.triangles.array() + static_cast<int>(a.points.cols())).matrix();
    return mesh;
}

}  // namespace scree::test
