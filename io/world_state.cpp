#include "io/world_state.h"

#include <utility>

#include "core/base/check.h"
#include "core/base/hash.h"
#include "io/build_world.h"

namespace scree {

FrameState captureState(const Shot& shot, const World& world, std::vector<SceneFrame> between)
{
    FrameState state;
    state.shotHash = hashText(shot.resolvedText);
    state.clock = world.clock;
    state.motion = world.motion;
    state.order = world.order;
    if (!world.births.empty()) state.bornAt = world.bornAt;
    state.contactMemory = world.contactMemory;
    state.scene = captureFrame(shot, world);
    state.scene.frame = shot.firstFrame + static_cast<int>(world.clock.frame);
    state.between = std::move(between);
    return state;
}

void restoreState(World& world, const FrameState& state)
{
    SCREE_CHECK(state.motion.size() == world.bodyCount(), "the state is of another world");
    world.motion = state.motion;
    world.order = state.order;
    world.clock = state.clock;
    // Who is keyed and who is free follows from the clock; the next step begins with it.
    SCREE_CHECK(state.bornAt.empty() == world.births.empty(), "the state is of another world");
    world.contactMemory = state.contactMemory;
    if (!state.bornAt.empty()) world.restoreBirths(state.bornAt);
}

}  // namespace scree
