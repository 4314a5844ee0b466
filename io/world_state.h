// A world as a frame keeps it, and back: going on from there gives the bits of never having
// stopped.
#pragma once

#include <vector>

#include "core/scene/world.h"
#include "io/frame_file.h"
#include "io/shot.h"

namespace scree {

/// The state of `world` with the poses that follow from it, and the samples met on the way there.
FrameState captureState(const Shot& shot, const World& world, std::vector<SceneFrame> between = {});

/// Gives `world`, built from the same shot, the state it had when `state` was captured.
void restoreState(World& world, const FrameState& state);

}  // namespace scree
