// preview/…: pictures of 1280 × 720 with their PNG files in memory, as `scree render` makes them:
// OSMesa one picture a thread, Embree all threads on one picture. Prints milliseconds of wall and
// CPU time per frame and a hash of the PNG bytes. SCREE_BENCHMARK_THREADS: how many threads [2].
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "io/mesh_import.h"
#include "render/png_writer.h"
#include "render/rasterizer.h"
#include "render/ray_tracer.h"
#include "tests/support/import_mesh.h"
#include "tests/support/preview_scene.h"
#include "tests/support/support.h"

namespace scree::test {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFramesPerThread = 4;

int benchmarkThreads()
{
    const char* text = std::getenv("SCREE_BENCHMARK_THREADS");
    return text ? std::max(1, std::atoi(text)) : 2;
}

PreviewScene rings()
{
    return heapOfRings(1000);
}

/// 300 skulls, 150 pelvises and 50 femurs, as in shots/bones_500.toml: 2.77 million triangles.
PreviewScene bones()
{
    const auto load = [](const char* name) {
        return importMesh(sourceFile(std::string("shots/meshes/") + name).string());
    };
    const TriMesh skull = load("skull.ply"), pelvis = load("pelvis.ply"), femur = load("femur.ply");
    PreviewScene heap = strewnHeap(skull, 0.9, 500);
    const std::size_t first = heap.scene.bodies.size() - 500, next = heap.scene.meshes.size();
    heap.scene.meshes.push_back({"pelvis", pelvis.points, pelvis.triangles});
    heap.scene.meshes.push_back({"femur", femur.points, femur.triangles});
    for (std::size_t i = 300; i < 500; ++i) heap.scene.bodies[first + i].mesh = next + (i >= 450);
    return heap;
}

std::uint64_t picture(PictureEngine& engine, const PreviewScene& scene)
{
    const std::vector<std::uint8_t> png =
        encodePng(engine.draw(scene.frame, scene.camera, kWidth, kHeight));
    return hashBytes(png.data(), png.size());
}

void label(benchmark::State& state, std::uint64_t hash)
{
    char text[32];
    std::snprintf(text, sizeof text, "png %016llx", static_cast<unsigned long long>(hash));
    state.SetLabel(text);
}

void rasterize(benchmark::State& state, PreviewScene (*makeScene)(), int samples)
{
    setThreadCount(benchmarkThreads());
    const PreviewScene scene = makeScene();
    RasterSettings settings;
    settings.samples = samples;
    std::vector<std::unique_ptr<Rasterizer>> engines;
    for (int i = 0; i < threadCount(); ++i) {
        engines.push_back(std::make_unique<Rasterizer>(scene.scene, scene.looks, settings));
        picture(*engines.back(), scene);  // shaders are compiled with the first picture
    }
    std::vector<std::uint64_t> hashes(engines.size());
    for (auto _ : state) {
        parallelFor(engines.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (int k = 0; k < kFramesPerThread; ++k) hashes[i] = picture(*engines[i], scene);
        });
    }
    const double frames = static_cast<double>(state.iterations()) * kFramesPerThread *
                          static_cast<double>(engines.size());
    state.counters["s_per_frame"] =
        benchmark::Counter(frames, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    label(state, hashes[0]);
}

void trace(benchmark::State& state, PreviewScene (*makeScene)(), int samples)
{
    setThreadCount(benchmarkThreads());
    const PreviewScene scene = makeScene();
    TraceSettings settings;
    settings.samples = samples;
    RayTracer engine(scene.scene, scene.looks, settings);
    std::uint64_t hash = 0;
    for (auto _ : state) hash = picture(engine, scene);
    state.counters["s_per_frame"] =
        benchmark::Counter(static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    label(state, hash);
}

#define SCREE_PREVIEW(function, name, ...)         \
    BENCHMARK_CAPTURE(function, name, __VA_ARGS__) \
        ->Name("preview/" #name)                   \
        ->Unit(benchmark::kMillisecond)            \
        ->MeasureProcessCPUTime()                  \
        ->UseRealTime()

SCREE_PREVIEW(rasterize, osmesa_rings_1000, rings, 1);
SCREE_PREVIEW(rasterize, osmesa_4_samples_rings_1000, rings, 4);
SCREE_PREVIEW(rasterize, osmesa_bones_500, bones, 1);
SCREE_PREVIEW(trace, embree_1_sample_rings_1000, rings, 1);
SCREE_PREVIEW(trace, embree_8_samples_rings_1000, rings, 8);
SCREE_PREVIEW(trace, embree_1_sample_bones_500, bones, 1);

}  // namespace
}  // namespace scree::test
