// Repairs that change nothing one could see or touch. Everything else a mesh lacks is refused, or
// mended on demand by level_set_remesh.h, ground_solid.h, room_solid.h and solidified_sheet.h.
#pragma once

#include <string>

#include "core/geometry/tri_mesh.h"

namespace scree {

/// What was done; all zero and false for a clean mesh.
struct HarmlessRepairs {
    int mergedPoints = 0;      ///< equal bit for bit to another, or used by no triangle
    int droppedTriangles = 0;  ///< two of their corners were one point
    int flippedEdges = 0;      ///< of triangles whose corners lie on one line
    bool isTurned = false;     ///< all triangles faced inward

    bool isNone() const
    {
        return mergedPoints == 0 && droppedTriangles == 0 && flippedEdges == 0 && !isTurned;
    }
};

/// Merges equal points, drops triangles that thereby lose a corner, gives the long edge of flat
/// triangles to their neighbour, and turns a mesh that is closed but wholly inside-out. A mesh with
/// indices or numbers that are none comes back as it is.
TriMesh repairHarmlessly(const TriMesh& mesh, HarmlessRepairs& repairs);

/// "merged 12 equal points, dropped 3 triangles without area"; empty when nothing was done.
std::string describe(const HarmlessRepairs& repairs);

}  // namespace scree
