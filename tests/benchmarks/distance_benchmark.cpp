// distance/…: one query of the ring's field, at random points of its box and within a few
// millimetres of its surface, where the refined value asks the triangles; and there again and again
// while the places move by micrometres, with what is known of the faces.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/base/random.h"
#include "core/geometry/known_field.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"

namespace scree {
namespace {

std::vector<Vec3> points(const Shape& shape, bool atSurface)
{
    std::vector<Vec3> result;
    for (std::uint64_t i = 0; result.size() < 4096; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) {
            p[k] = shape.box.min[k] + shape.box.size()[k] * randomUnit(5, i, k);
        }
        if (!atSurface || std::abs(shape.distance.value(p)) < 0.005) result.push_back(p);
    }
    return result;
}

void query(benchmark::State& state, bool atSurface,
           double (SignedDistance::*ask)(const Vec3&) const)
{
    const auto shape = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const std::vector<Vec3> where = points(*shape, atSurface);
    std::size_t i = 0;
    double sum = 0.0;
    for (auto _ : state) sum += (shape->distance.*ask)(where[i++ % where.size()]);
    benchmark::DoNotOptimize(sum);
}

void queryKnown(benchmark::State& state)
{
    const auto shape = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const std::vector<Vec3> where = points(*shape, true);
    std::vector<KnownFaces> known(where.size());
    std::size_t i = 0, round = 0;
    double sum = 0.0;
    for (auto _ : state) {
        const Vec3 away = Vec3::Constant(1e-6 * static_cast<double>(round % 16));
        sum += KnownField(shape->distance, &known[i]).value(where[i] + away);
        if (++i == where.size()) i = 0, ++round;
    }
    benchmark::DoNotOptimize(sum);
}

BENCHMARK_CAPTURE(query, grid_anywhere, false, &SignedDistance::gridValue)
    ->Name("distance/ring_grid_anywhere");
BENCHMARK_CAPTURE(query, refined_anywhere, false, &SignedDistance::value)
    ->Name("distance/ring_refined_anywhere");
BENCHMARK_CAPTURE(query, refined_at_surface, true, &SignedDistance::value)
    ->Name("distance/ring_refined_at_surface");
BENCHMARK(queryKnown)->Name("distance/ring_known_at_surface");

}  // namespace
}  // namespace scree
