// Scenes for POV-Ray (.pov), one per frame, to render without any cache: meshes, materials and sky
// once in <name>_meshes.inc beside the frames, and in each frame the bodies as instances of them,
// the camera and the sun.
//
// POV-Ray's axes are left-handed by habit only: with the camera's own vectors written out, the
// shot's coordinates are used as they are and nothing appears mirrored. POV-Ray looks for the
// include file in the folder it is started in, so render there, with the aspect of the shot:
//
//   cd folder; povray +Iheap.1001.pov +Oheap.1001.png +W960 +H540 +A -D
#pragma once

#include <filesystem>
#include <memory>

#include "io/frame_writer.h"

namespace scree {

/// `output` has a place for the frame number (io/frame_pattern.h). The camera is the shot's first;
/// without one, a view of all that moves in the first frame. Every file appears complete; equal
/// input gives equal bytes.
std::unique_ptr<FrameWriter> makePovWriter(const std::filesystem::path& output);

}  // namespace scree
