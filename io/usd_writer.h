// USD caches as text (.usda), in two forms that hold the same motion:
//
//   out.usda            a prim per body, named as in the shot, that refers to a shared mesh and has
//                       translation and rotation at every time. For sets one works in by hand.
//   out.instances.usda  one PointInstancer for all bodies that move: arrays of positions,
//                       orientations and velocities. For heaps of very many bodies.
//
// Rotations are quaternions, not matrices: readers interpolate those along the arc, matrices by
// their entries, which would shrink a spinning body between two frames. Axes and unit are the
// shot's, and said in the header. Time codes are frame numbers, fractions are parts of a frame.
// `usdcat out.usda -o out.usdc`, from USD itself, makes the binary form, which opens faster.
#pragma once

#include <filesystem>
#include <memory>

#include "io/frame_writer.h"

namespace scree {

/// One file with all times. Times of a body between equal poses are left out, and bodies that never
/// move have no times at all. Memory does not grow with frames, but for 8 bytes each; equal input
/// gives equal bytes.
std::unique_ptr<FrameWriter> makeUsdWriter(const std::filesystem::path& output);

/// The same with /<shot>/Bodies, a PointInstancer. `ids` are the bodies' numbers in the scene, and
/// the primvars bodyName and mass are parallel to it. Bodies that cannot be moved stay prims.
/// Readers that advance positions by velocities are exact at the times written, and between them
/// see each body fly on until the next time.
std::unique_ptr<FrameWriter> makeUsdInstancesWriter(const std::filesystem::path& output);

}  // namespace scree
