// The one door to OpenVDB: a closed mesh becomes signed distances at the nodes of a dense grid.
// [A4]
#pragma once

#include <array>
#include <vector>

#include "core/geometry/surface_rays.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// Node (i, j, k) lies at origin + spacing · (i, j, k) and is stored at i + n₀ (j + n₁ k).
struct GridNodes {
    Vec3 origin = Vec3::Zero();  ///< [m]
    double spacing = 0.0;        ///< [m]
    std::array<int, 3> count = {0, 0, 0};
    std::vector<float> values;  ///< signed distance, negative inside [m]
};

/// Fills nodes.values for the lattice given by the other fields. OpenVDB finds the distances in a
/// band around the surface and, by flooding, which side every node is on; beyond the band the
/// distance is that to the closest triangle. The result does not depend on the number of threads.
void fillSignedDistance(const TriMesh& mesh, const SurfaceRays& rays, GridNodes& nodes);

}  // namespace scree
