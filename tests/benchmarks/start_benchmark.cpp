// start: from a shot file to a world that can be stepped: meshes read and checked, distance fields
// of their shapes built, or read from the cache that an earlier start has filled.
#include <benchmark/benchmark.h>

#include <string>

#include "core/base/parallel.h"
#include "io/build_world.h"
#include "io/distance_cache.h"
#include "io/shot_parser.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

void start(benchmark::State& state, const char* shotFile, bool isCached)
{
    setThreadCount(2);
    const std::string file = sourceFile(shotFile).string();
    const TemporaryFolder folder;
    DistanceCache cache(isCached ? folder / "fields" : std::filesystem::path());
    buildWorld(parseShot(file), &cache);
    for (auto _ : state) benchmark::DoNotOptimize(buildWorld(parseShot(file), &cache));
}

#define SCREE_START(name, ...)                  \
    BENCHMARK_CAPTURE(start, name, __VA_ARGS__) \
        ->Name("start/" #name)                  \
        ->Unit(benchmark::kMillisecond)         \
        ->MeasureProcessCPUTime()               \
        ->UseRealTime()

SCREE_START(bones_500, "shots/bones_500.toml", false);
SCREE_START(bones_500_cached, "shots/bones_500.toml", true);
SCREE_START(rings_1000, "shots/rings_1000.toml", false);
SCREE_START(rings_1000_cached, "shots/rings_1000.toml", true);

}  // namespace
}  // namespace scree::test
