// A run that is stopped at every occasion and goes on elsewhere.
#pragma once

#include "core/dynamics/stepper.h"

namespace scree::test {

/// Runs a world of method `paper` for so many frames. Wherever it may stop it goes on in a fresh
/// world, with a stepper that knows nothing, and with only what a checkpoint of that method holds:
/// motion, order, clock. `stops` counts how often.
template <class MakeWorld>
World runBroken(const MakeWorld& makeWorld, const StepSettings& settings, int frames, int& stops)
{
    World world = makeWorld();
    stops = 0;
    while (world.clock.frame < frames) {
        World fresh = makeWorld();
        fresh.motion = world.motion;
        fresh.order = world.order;
        fresh.clock = world.clock;
        world = fresh;
        Stepper stepper(settings);
        stops += !stepper.advanceFrame(world, 1.0 / 24.0, [] { return true; }).finished;
    }
    return world;
}

}  // namespace scree::test
