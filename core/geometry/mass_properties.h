// Volume, centre of mass and principal moments of a closed mesh, exact for the polyhedron.
// [Mir96], [A2, A3]
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree {

/// Of a solid with density 1 kg/m³, so that mass = density × volume and moments scale alike.
struct MassProperties {
    double volume = 0.0;                        ///< [m³]
    double area = 0.0;                          ///< of the surface [m²]
    Vec3 centre = Vec3::Zero();                 ///< centre of mass, mesh frame [m]
    Vec3 moments = Vec3::Zero();                ///< principal moments about it, ascending [m⁵]
    Quat meshFromPrincipal = Quat::Identity();  ///< principal axes in the mesh frame
};

/// Throws Error{badInput} when the volume is not positive. Where two or three moments are equal to
/// 1e-5 the axes nearest to the mesh's own are taken, so that noise decides nothing.  [A3]
MassProperties massProperties(const TriMesh& mesh);

}  // namespace scree
