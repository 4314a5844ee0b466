// frame/stack: cubes of a metre on each other for ten seconds, at one fixed step a frame and at
// ten, and by how much the top has sunk and drifted at the end. Printed as of the other frames.
//
// frame/wall: bricks that lean over and fall, by columns and layers, at four steps a frame and at
// sixteen, which should not cost four times as much.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/base/parallel.h"
#include "core/dynamics/stepper.h"
#include "tests/benchmarks/frame_tally.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

void simulateFrames(benchmark::State& state, int steps, World& world)
{
    StepSettings settings = screeSettings();
    settings.substeps.min = settings.substeps.max = steps;
    Stepper stepper(settings);
    FrameTally tally;
    for (auto _ : state) tally.add(stepper.advanceFrame(world, 1.0 / 24.0));
    tally.tell(state);
}

void simulateStack(benchmark::State& state)
{
    const auto cubes = static_cast<int>(state.range(0));
    const auto topMass = static_cast<double>(state.range(1));
    setThreadCount(1);
    World world = stackOfCubes(cubes, topMass);
    const BodyId top = static_cast<BodyId>(world.bodyCount()) - 1;
    const Vec3 start = world.motion[top].position;
    simulateFrames(state, static_cast<int>(state.range(2)), world);
    const Vec3 way = world.motion[top].position - start;
    state.counters["sinks_mm"] = -1e3 * way.y();
    state.counters["drifts_mm"] = 1e3 * std::hypot(way.x(), way.z());
}

BENCHMARK(simulateStack)
    ->Name("frame/stack")
    ->ArgNames({"cubes", "top_kg", "steps"})
    ->ArgsProduct({{40}, {1}, {1, 10}})
    ->ArgsProduct({{10}, {100}, {1, 10}})
    ->ArgsProduct({{2}, {1000, 10000}, {1, 10}})
    ->Apply(byFrames);

void simulateWall(benchmark::State& state)
{
    setThreadCount(1);
    World world = leaningWall(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    simulateFrames(state, static_cast<int>(state.range(2)), world);
}

BENCHMARK(simulateWall)
    ->Name("frame/wall")
    ->ArgNames({"columns", "layers", "steps"})
    ->ArgsProduct({{12}, {30}, {4, 16}})
    ->Iterations(24)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace scree::test
