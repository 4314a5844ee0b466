// Threads that are asked for are there.
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/geometry/primitives.h"
#include "core/geometry/surface_rays.h"

namespace scree::test {
namespace {

/// How many of two ranges run at the same time: each waits for the other to begin.
int rangesAtOnce()
{
    std::atomic<int> begun = 0;
    std::atomic<int> met = 0;
    parallelFor(2, 1, [&](std::size_t, std::size_t) {
        ++begun;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
        while (begun < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        met += begun == 2 && std::chrono::steady_clock::now() < end;
    });
    return met;
}

// Embree, told to build its trees on one thread, limits every parallel loop of the process.
TEST(Parallel, BothThreadsWorkAlsoAfterRaysHaveBeenCastAtAMesh)
{
    setThreadCount(2);
    const SurfaceRays rays(makeBox(Vec3::Ones(), {1, 1, 1}));
    EXPECT_TRUE(rays.firstHit({0.0, 0.0, 3.0}, {0.0, 0.0, -1.0}, 10.0, SurfaceRays::Facing::any));
    EXPECT_EQ(rangesAtOnce(), 2);
    setThreadCount(1);
}

}  // namespace
}  // namespace scree::test
