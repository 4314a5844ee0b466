// How far two surfaces are apart, and where: what is drawn against what collides.
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree {

/// Where two surfaces disagree most.
struct MeshDeviation {
    double distance = 0.0;      ///< from the place to the other surface [m]
    Vec3 place = Vec3::Zero();  ///< in the frame of the meshes [m]
    bool isOnFirst = true;      ///< whether the place belongs to the first of them
};

/// Looks from the points of either surface, and from points spread over faces that are large, at
/// most a 64th of the box apart. What lies between these is missed, so the distance is a lower
/// bound, short by at most that spacing. Both need at least one triangle.
MeshDeviation farthestApart(const TriMesh& a, const TriMesh& b);

/// The same where `drawn` can be seen: of parts that pierce each other not what lies within the
/// others, which no solid of them all has.
MeshDeviation farthestApartInSight(const TriMesh& drawn, const TriMesh& solid);

}  // namespace scree
