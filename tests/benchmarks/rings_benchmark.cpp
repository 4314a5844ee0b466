// frame/rings_100: the whole shot, a frame an iteration, and what the independent judge says of it.
// Prints milliseconds per frame and sub-step, contact pairs, the state hash and the overlap found.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/shot_parser.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

/// The judge's trajectory format: header, then position and orientation (w x y z) of every ring.
class Trajectory {
public:
    Trajectory(const std::filesystem::path& path, const World& world, double framesPerSecond)
        : file_(path, std::ios::binary)
    {
        for (std::size_t b = 0; b < world.bodyCount(); ++b) {
            if (world.mass[b].isMovable()) rings_.push_back(static_cast<BodyId>(b));
        }
        const std::array<std::uint32_t, 2> counts = {static_cast<std::uint32_t>(rings_.size()), 0};
        file_.write("RTRJ0001", 8);
        file_.write(reinterpret_cast<const char*>(counts.data()), sizeof counts);
        file_.write(reinterpret_cast<const char*>(&framesPerSecond), sizeof framesPerSecond);
    }
    void add(const World& world)
    {
        for (BodyId b : rings_) {
            const Pose pose = world.worldFromAsset(b);
            const std::array<double, 7> row = {pose.position.x(),    pose.position.y(),
                                               pose.position.z(),    pose.orientation.w(),
                                               pose.orientation.x(), pose.orientation.y(),
                                               pose.orientation.z()};
            file_.write(reinterpret_cast<const char*>(row.data()), sizeof row);
        }
        ++frames_;
    }
    void finish()
    {
        file_.seekp(12);
        file_.write(reinterpret_cast<const char*>(&frames_), sizeof frames_);
        file_.close();
    }

private:
    std::ofstream file_;
    std::vector<BodyId> rings_;
    std::uint32_t frames_ = 0;
};

std::string judge(const std::filesystem::path& trajectory)
{
    const std::string command = std::string(SCREE_JUDGE) +
                                " scene=" + sourceFile("tests/peers/rings_100.json").string() +
                                " traj=" + trajectory.string() + " tag=rings_100";
    std::string verdict;
    if (FILE* pipe = popen(command.c_str(), "r")) {
        std::array<char, 4096> buffer;
        while (fgets(buffer.data(), buffer.size(), pipe)) verdict += buffer.data();
        pclose(pipe);
    }
    return verdict;
}

/// The number behind `key` of the judge's verdict, after `section`.
double figure(const std::string& verdict, const std::string& section, const std::string& key)
{
    const std::size_t start = verdict.find("\"" + section + "\"");
    const std::size_t at = verdict.find("\"" + key + "\":", start);
    return at == std::string::npos ? -1.0 : std::stod(verdict.substr(at + key.size() + 3));
}

void simulateRings(benchmark::State& state)
{
    setThreadCount(static_cast<int>(state.range(0)));
    const Shot shot = parseShot(sourceFile("shots/rings_100.toml").string());
    World world = buildWorld(shot);
    Stepper stepper(shot.settings);
    const TemporaryFolder folder;
    Trajectory trajectory(folder / "rings.traj", world, shot.framesPerSecond);
    trajectory.add(world);

    std::int64_t steps = 0, contacts = 0, frames = 0;
    double seconds = 0.0;
    FrameReport report;
    for (auto _ : state) {
        report = stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
        state.PauseTiming();
        for (double phase : report.sum.seconds) seconds += phase;
        steps += report.steps;
        contacts += report.sum.contactPairs;
        ++frames;
        trajectory.add(world);
        state.ResumeTiming();
    }
    trajectory.finish();
    const std::string verdict = judge(folder / "rings.traj");
    state.counters["ms_per_substep"] = 1e3 * seconds / static_cast<double>(steps);
    state.counters["substeps"] = static_cast<double>(steps) / static_cast<double>(frames);
    state.counters["contact_pairs"] = static_cast<double>(contacts) / static_cast<double>(frames);
    state.counters["overlap_mm_worst"] = figure(verdict, "depth_all_frames_mm", "max");
    state.counters["overlap_mm_end"] = figure(verdict, "depth_end_mm", "max");
    state.counters["linked"] = figure(verdict, "end", "linked_ring_pairs");
    state.counters["gap_mm"] = figure(verdict, "end", "floor_clearance_mean_mm");
    std::array<char, 32> hash;
    std::snprintf(hash.data(), hash.size(), "%016llx",
                  static_cast<unsigned long long>(report.stateHash));
    state.SetLabel(hash.data());
}

BENCHMARK(simulateRings)
    ->Name("frame/rings_100")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(240)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace scree::test
