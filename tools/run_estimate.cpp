#include "tools/run_estimate.h"

#include <sys/resource.h>

#include <algorithm>

#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/frame_stats.h"
#include "io/ply_mesh.h"
#include "io/take_info.h"
#include "io/world_state.h"
#include "tools/broken_frame.h"
#include "tools/cpu_time.h"

namespace scree {
namespace {

/// Places at which a body of a heap bears on others: 4.0 in the middle and 4.4 at the end of
/// shots/rings_100, 3.6 in shots/stack_10.
constexpr std::size_t kContactsPerBody = 4;

/// A frame as it will be once the heap lies: in the first ones nothing touches yet, and what is
/// remembered of contacts is a third of a file.
std::uint64_t frameBytes(const Shot& shot, const World& world)
{
    FrameState state = captureState(shot, world);
    std::size_t movable = 0;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body)
        movable += world.massWhenBorn(body).isMovable();
    const std::size_t contacts = kContactsPerBody * movable;
    if (shot.settings.method == Method::scree) {
        ContactMemory& memory = state.contactMemory;
        memory.dt = 1.0;
        memory.rest.resize(world.bodyCount());
        memory.contacts.resize(std::max(contacts, memory.contacts.size()));
    }
    if (shot.output.contacts) {
        state.lastStep.emplace();
        state.lastStep->level.resize(world.bodyCount());
        state.lastStep->overlap.resize(world.bodyCount());
        state.lastStep->contacts.resize(contacts);
    }
    // A sub-frame sample holds poses and velocities alone, which is what the scene part holds.
    const std::uint64_t sampleBytes = 13 * sizeof(double) * world.bodyCount();
    const auto samples =
        std::ranges::count_if(shot.output.subframes, [](double offset) { return offset != 0.0; });
    return encodeFrame(state).size() + static_cast<std::uint64_t>(samples) * sampleBytes;
}

/// Of a whole take: frames, their figures, meshes and description.
std::uint64_t takeBytes(const Shot& shot, const World& world, const FrameReport& lastReport)
{
    const auto frames = static_cast<std::uint64_t>(shot.lastFrame - shot.firstFrame + 1);
    const std::string line = encodeStats({.frame = shot.lastFrame, .report = lastReport}, world);
    std::uint64_t bytes = frames * (frameBytes(shot, world) + line.size() + 1);
    const SceneDescription scene = describeScene(shot, world, 1.0);
    for (const SceneMesh& mesh : scene.meshes)
        bytes += encodePlyMesh({mesh.points, mesh.triangles, mesh.cornerUvs}).size();
    return bytes + encodeTakeInfo(makeTakeInfo(shot, world, scene, "")).size();
}

}  // namespace

double bodyFrames(const World& world, double frames)
{
    std::size_t always = 0;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body)
        always += world.massWhenFree(body) > 0.0;
    always -= world.births.size();
    double sum = frames * static_cast<double>(always);
    for (const PlannedBirth& birth : world.births)
        sum += std::max(0.0, frames - static_cast<double>(birth.frame));
    return sum;
}

RunEstimate estimateRun(const Shot& shot, const World& world, int frames, double mostSeconds,
                        const std::function<bool()>& stopRequested)
{
    RunEstimate estimate;
    World copy = world;
    Stepper stepper(shot.settings);
    const Stopwatch watch;
    const double cpuBefore = cpuSeconds();
    const auto isOver = [&] { return watch.seconds() >= mostSeconds || stopRequested(); };
    double framesDone = 0.0;
    FrameReport lastReport;
    const double duration = 1.0 / shot.framesPerSecond;
    frames = std::min(frames, shot.lastFrame - shot.firstFrame);
    while (framesDone < frames && !isOver()) {
        const FrameReport report = stepper.advanceFrame(copy, duration, isOver);
        lastReport = report;
        estimate.stepsTried += report.steps;
        framesDone += report.finished ? 1.0 : copy.clock.frameTimeDone / duration;
        ++estimate.framesTried;
        estimate.complaint = complaintOf(report, copy, shot.firstFrame + estimate.framesTried);
        if (!report.finished || !estimate.complaint.empty()) break;
    }
    const int total = shot.lastFrame - shot.firstFrame;
    const double tried = bodyFrames(world, framesDone);
    const double scale = tried > 0.0        ? bodyFrames(world, total) / tried
                         : framesDone > 0.0 ? total / framesDone
                                            : 0.0;
    estimate.wallSeconds = scale * watch.seconds();
    estimate.cpuSeconds = scale * (cpuSeconds() - cpuBefore);

    estimate.bodiesToCome =
        static_cast<int>(std::ranges::count_if(copy.births, [&](const PlannedBirth& birth) {
            return copy.bornAt[birth.body] == kUnborn;
        }));

    estimate.diskBytes = takeBytes(shot, copy, lastReport);
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    estimate.memoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return estimate;
}

}  // namespace scree
