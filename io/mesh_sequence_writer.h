// Mesh sequences: one file per frame with all bodies at their places in the world, for programs
// that know neither Alembic nor USD. Axes and unit are the shot's.
//
// OBJ: one object `o <body>` per body, points numbered through the file, every number in the
// shortest decimal form that reads back to the same double. PLY: binary, little endian. Points are
// double x y z, float vx vy vz (velocity of the point in units per second, for motion blur) and int
// body; `comment body <number> <name>` says which is which.
#pragma once

#include <filesystem>
#include <memory>

#include "io/frame_writer.h"

namespace scree {

/// `output` has a place for the frame number (io/frame_pattern.h). Every frame's file appears
/// complete.
std::unique_ptr<FrameWriter> makeObjSequenceWriter(const std::filesystem::path& output);
std::unique_ptr<FrameWriter> makePlySequenceWriter(const std::filesystem::path& output);

}  // namespace scree
