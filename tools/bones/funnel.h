// The funnel of shots/bones_500.toml: a closed solid of revolution.
#pragma once

#include "core/geometry/tri_mesh.h"

namespace scree {

/// Axis +y, origin in the middle of the outlet: a cone open above, with a short pipe below and
/// walls of equal thickness and an upright collar.
TriMesh makeFunnel();

}  // namespace scree
