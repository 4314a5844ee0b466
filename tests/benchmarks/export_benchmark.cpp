// export/<format>_1000: a thousand tumbling bodies for 240 frames into each format that holds all
// frames in one file. The frames are made beforehand, so that only writing is timed. The disk is
// the one that holds the temporary folder.
#include <benchmark/benchmark.h>

#include <string>

#include "io/frame_writer.h"
#include "tests/support/export_scene.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

constexpr int kBodies = 1000;
constexpr int kFrames = 240;

SceneDescription manyBodies()
{
    SceneDescription scene = sceneOf({});
    for (int i = 0; i < kBodies; ++i) scene.bodies.push_back(bodyNamed("b" + std::to_string(i)));
    return scene;
}

void exportCache(benchmark::State& state, const std::string& ending)
{
    const SceneDescription scene = manyBodies();
    std::vector<SceneFrame> frames;
    for (int i = 0; i < kFrames; ++i) frames.push_back(tumblingFrame(scene, 1001 + i, 1001));

    const TemporaryFolder folder;
    for (auto _ : state) {
        const std::unique_ptr<FrameWriter> writer = makeFrameWriter(folder / ("out." + ending));
        writer->begin(scene, 1001, kFrames);
        for (const SceneFrame& frame : frames) writer->write(frame);
        writer->finish();
    }
    state.counters["MB"] =
        1e-6 * static_cast<double>(std::filesystem::file_size(folder / ("out." + ending)));
}

const bool kRegistered = [] {
    for (const std::string ending : {"abc", "usda", "instances.usda", "glb"}) {
        benchmark::RegisterBenchmark(
            ("export/" + ending + "_1000").c_str(),
            [ending](benchmark::State& state) { exportCache(state, ending); })
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime()
            ->Iterations(3);
    }
    return true;
}();

}  // namespace
}  // namespace scree::test
