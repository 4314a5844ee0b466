// The PointInstancer of a USD file: all bodies that move as parallel arrays.
#pragma once

#include "io/frame_writer.h"
#include "io/motion_spool.h"
#include "io/usd_stage.h"

namespace scree {

/// Writes /<shot>/<instancer> with the bodies of `motion`; nothing when there are none. Bodies of
/// the same mesh, material and mass share a prototype.
void writeUsdInstancer(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                       int firstFrame, MotionSpool& motion, const FinishWatch& watch);

}  // namespace scree
