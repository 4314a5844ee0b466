#include "tools/run_estimate.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

#include "core/dynamics/stepper.h"
#include "io/take.h"
#include "tools/cpu_time.h"

namespace scree {

RunEstimate estimateRun(const Shot& shot, const World& world, int frames, double mostSeconds)
{
    RunEstimate estimate;
    World copy = world;
    Stepper stepper(shot.settings);
    const auto started = std::chrono::steady_clock::now();
    const double cpuBefore = cpuSeconds();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    };
    double framesDone = 0.0;
    const double duration = 1.0 / shot.framesPerSecond;
    frames = std::min(frames, shot.lastFrame - shot.firstFrame);
    while (framesDone < frames && elapsed() < mostSeconds) {
        const FrameReport report =
            stepper.advanceFrame(copy, duration, [&] { return elapsed() >= mostSeconds; });
        estimate.stepsTried += report.steps;
        framesDone += report.finished ? 1.0 : copy.clock.frameTimeDone / duration;
        ++estimate.framesTried;
        if (!report.finished || !report.sum.nonFinite.empty()) break;
    }
    const int total = shot.lastFrame - shot.firstFrame;
    const double scale = framesDone > 0.0 ? total / framesDone : 0.0;
    estimate.wallSeconds = scale * elapsed();
    estimate.cpuSeconds = scale * (cpuSeconds() - cpuBefore);

    // A sub-frame sample holds poses and velocities alone, which is what the scene part holds.
    const std::uint64_t frameBytes = encodeFrame(captureState(shot, copy)).size();
    const std::uint64_t sampleBytes = 13 * sizeof(double) * world.bodyCount();
    const std::size_t samples = shot.output.subframes.size();
    estimate.diskBytes = (frameBytes + samples * sampleBytes) * (total + 1);
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    estimate.memoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return estimate;
}

}  // namespace scree
