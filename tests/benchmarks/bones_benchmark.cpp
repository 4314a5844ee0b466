// frame/bones: the shot of five hundred bones, 2.77 million triangles, none of them taken for its
// hull. Printed as of the other frames, with the deepest overlap that the solver knows of and who
// is awake at the end.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/shot_parser.h"
#include "tests/benchmarks/frame_tally.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

void simulateBones(benchmark::State& state)
{
    setThreadCount(static_cast<int>(state.range(0)));
    const Shot shot = parseShot(sourceFile("shots/bones_500.toml").string());
    World world = buildWorld(shot);
    Stepper stepper(shot.settings);
    FrameTally tally;
    FrameReport report;
    double deepest = 0.0;
    for (auto _ : state) {
        report = stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
        tally.add(report);
        deepest = std::max(deepest, report.sum.deepestAfterPushOut);
    }
    tally.tell(state);
    state.counters["overlap_mm_worst"] = 1e3 * deepest;
    state.counters["overlap_mm_end"] = 1e3 * report.sum.deepestAfterPushOut;
    state.counters["awake_end"] = report.bodiesAwake;
}

BENCHMARK(simulateBones)
    ->Name("frame/bones")
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Apply(byFrames);

}  // namespace
}  // namespace scree::test
