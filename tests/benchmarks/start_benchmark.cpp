// start: from a shot file to a world that can be stepped: meshes read and checked, distance fields
// of their shapes built, or read from the cache that an earlier start has filled.
#include <benchmark/benchmark.h>

#include <string>

#include "core/base/parallel.h"
#include "io/build_world.h"
#include "io/shape_cache.h"
#include "io/shot_parser.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

Shot bones()
{
    return parseShot(sourceFile("shots/bones_500.toml").string());
}

/// Their three shapes alone, of 20 000 triangles in all.
Shot threeBones()
{
    Shot shot = bones();
    std::erase_if(shot.shapes, [](const ShotShape& shape) {
        return shape.name == "funnel" || shape.name == "wall";
    });
    std::erase_if(shot.bodies,
                  [](const ShotBody& body) { return !body.plane && body.kind == BodyKind::fixed; });
    return shot;
}

Shot rings()
{
    return parseShot(sourceFile("shots/rings_1000.toml").string());
}

void start(benchmark::State& state, Shot (*readShot)(), bool isCached)
{
    setThreadCount(2);
    const TemporaryFolder folder;
    ShapeCache cache(isCached ? folder / "fields" : std::filesystem::path());
    buildWorld(readShot(), &cache);
    for (auto _ : state) benchmark::DoNotOptimize(buildWorld(readShot(), &cache));
}

#define SCREE_START(name, ...)                  \
    BENCHMARK_CAPTURE(start, name, __VA_ARGS__) \
        ->Name("start/" #name)                  \
        ->Unit(benchmark::kMillisecond)         \
        ->MeasureProcessCPUTime()               \
        ->UseRealTime()

SCREE_START(three_bones, threeBones, false);
SCREE_START(three_bones_cached, threeBones, true);
SCREE_START(bones_500, bones, false);
SCREE_START(bones_500_cached, bones, true);
SCREE_START(rings_1000, rings, false);
SCREE_START(rings_1000_cached, rings, true);

}  // namespace
}  // namespace scree::test
