// Alembic caches (.abc, Ogawa container): one transform per body, its mesh below it.
//
//   /<shot>                     transform: the shot's axes in Alembic's
//   /<shot>/<body>              transform: one matrix per sample, one in all for bodies that never
//                               move; user properties mass, material, shape, bodyId, birthFrame
//   /<shot>/<body>/<body>Shape  polygon mesh, constant, in the artist's frame, with normals; its
//                               face set has the name of the material
//   /<shot>/<camera>            transform, and below it the camera
//
// Alembic stores no up axis and no unit; by convention it is y-up. A z-up shot is therefore turned
// by −90° about x, once, at /<shot>; lengths stay in the shot's unit, and /<shot> has it as the
// user property metresPerUnit. Frame f stands at f / fps seconds, as all common tools have it, and
// sub-frame samples where they were taken. Meshes have no velocities: those are for points that
// move by themselves, and renderers blur rigid bodies by the samples of their transforms.
#pragma once

#include <filesystem>
#include <memory>

#include "io/frame_writer.h"

namespace scree {

/// One file with all frames. Memory per body and frame is one 8-byte word while a body moves; equal
/// input gives equal bytes.
std::unique_ptr<FrameWriter> makeAlembicWriter(const std::filesystem::path& output);

}  // namespace scree
