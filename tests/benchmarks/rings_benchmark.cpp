// frame/rings: rings on poles, a frame an iteration, and what the independent judge says of it.
// Prints milliseconds per frame, wall and CPU, and of each phase; sub-steps, contacts, the overlap
// found and the state hash. Ten thousand rings are ten fields of a thousand side by side, or a
// hundred fields of a hundred: what a ring costs there against one field alone says how cost grows.
#include <benchmark/benchmark.h>

#include <algorithm>
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
#include "tests/benchmarks/frame_tally.h"
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

std::string judge(int rings, const std::filesystem::path& trajectory)
{
    const std::string scene = "tests/peers/rings_" + std::to_string(rings) + ".json";
    const std::string command = std::string(SCREE_JUDGE) + " scene=" + sourceFile(scene).string() +
                                " traj=" + trajectory.string() + " tag=scree";
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

/// Poles and rings once more beside themselves, in a row of fields.
void repeatBeside(Shot& shot, int copies)
{
    constexpr double kFieldWidth = 60.0;  // [m]; the heap of one reaches 25 m from its middle
    const std::vector<ShotBody> once = shot.bodies;
    for (int copy = 1; copy < copies; ++copy) {
        for (ShotBody body : once) {
            if (body.plane) continue;
            body.name += "_" + std::to_string(copy);
            body.worldFromAsset.position.x() += kFieldWidth * copy;
            shot.bodies.push_back(body);
        }
    }
}

void simulateRings(benchmark::State& state)
{
    const auto rings = static_cast<int>(state.range(0));
    setThreadCount(static_cast<int>(state.range(1)));
    const auto ringsOfField = static_cast<int>(state.range(2));
    const int copies = rings / ringsOfField;
    const std::string file = "shots/rings_" + std::to_string(ringsOfField) + ".toml";
    Shot shot = parseShot(sourceFile(file).string());
    repeatBeside(shot, copies);
    World world = buildWorld(shot);
    Stepper stepper(shot.settings);
    const TemporaryFolder folder;
    Trajectory trajectory(folder / "rings.traj", world, shot.framesPerSecond);
    trajectory.add(world);

    FrameTally tally;
    for (auto _ : state) {
        const FrameReport report = stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
        state.PauseTiming();
        tally.add(report);
        trajectory.add(world);
        state.ResumeTiming();
    }
    trajectory.finish();
    tally.tell(state);
    if (copies == 1) {  // the judge knows the scenes of 100, 500 and 1000 rings
        const std::string verdict = judge(rings, folder / "rings.traj");
        state.counters["overlap_mm_worst"] = figure(verdict, "depth_all_frames_mm", "max");
        state.counters["overlap_mm_end"] = figure(verdict, "depth_end_mm", "max");
        state.counters["linked"] = figure(verdict, "end", "linked_ring_pairs");
        state.counters["gap_mm"] = figure(verdict, "end", "floor_clearance_mean_mm");
        state.counters["moving"] = figure(verdict, "last_second", "moving_fraction");
    }
}

BENCHMARK(simulateRings)
    ->Name("frame/rings")
    ->ArgNames({"rings", "threads", "field"})
    ->ArgsProduct({{100}, {1, 2}, {100}})
    ->ArgsProduct({{500}, {1, 2}, {500}})
    ->ArgsProduct({{1000}, {1, 2}, {1000}})
    ->ArgsProduct({{10000}, {1, 2}, {100, 1000}})
    ->Apply(byFrames);

}  // namespace
}  // namespace scree::test
