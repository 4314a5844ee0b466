// Binary glTF (.glb), for browsers and quick looks: a node per body with animated translation and
// rotation, meshes whose data all bodies of a shape share, colours, roughness and cameras.
//
//   <shot>          node: the shot's axes and unit in glTF's, which are y-up and metres
//   <shot>/<body>   node under the name the shot gives it; extras: bodyId, mass, material
//   <camera>        node beside the shot's, since viewers treat a scaled camera differently
//
// Animation starts at 0 s, as the format wants, and that is the first frame: a key at t seconds is
// frame firstFrame + t · framesPerSecond, both told by extras of the animation. Samples between
// frames are kept, but for those before the first one, for which the format has no time.
#pragma once

#include <filesystem>
#include <memory>

#include "io/frame_writer.h"

namespace scree {

/// One file with all times. Numbers of the motion are single precision, which is all glTF has.
/// Memory does not grow with frames, but for 8 bytes each; equal input gives equal bytes. finish()
/// throws Error{badInput} for more than the 4 GiB a .glb can hold.
std::unique_ptr<FrameWriter> makeGltfWriter(const std::filesystem::path& output);

}  // namespace scree
