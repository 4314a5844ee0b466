// What a run will take, from a few frames of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

struct RunEstimate {
    int framesTried = 0;
    int stepsTried = 0;
    double cpuSeconds = 0.0, wallSeconds = 0.0;  ///< for all frames of the shot, if they go on so
                                                 ///< with as many bodies as there are by then
    int bodiesToCome = 0;                        ///< that no frame tried has seen
    std::uint64_t diskBytes = 0;                 ///< of the take
    std::uint64_t memoryBytes = 0;               ///< the most this process had
    std::string complaint;                       ///< what broke a frame that was tried; else ""
};

/// How many bodies there are to be moved in each of so many frames from the first, added up; a part
/// of a frame counts as that.
double bodyFrames(const World& world, double frames);

/// Simulates the first `frames` of a copy of the world, or as many as begin within `mostSeconds`.
/// Bodies still in the air are cheap: a heap that forms later costs more than this says.
/// Ends early when `stopRequested` says so.
RunEstimate estimateRun(const Shot& shot, const World& world, int frames, double mostSeconds,
                        const std::function<bool()>& stopRequested);

}  // namespace scree
