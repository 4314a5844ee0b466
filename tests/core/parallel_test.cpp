// Threads that are asked for are there.
#include "core/base/parallel.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.h"
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

TEST(Parallel, MoreThreadsThanTheSystemAllowsAreRefusedAndNothingIsLeftOfThem)
{
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit tight = before;
    tight.rlim_cur = pages * 4096 + (rlim_t{512} << 20);  // stacks of a few dozen threads
    ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
    std::string message;
    try {
        setThreadCount(4096);
    } catch (const Error& error) {
        message = error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_NE(message.find("cannot run 4096 threads"), std::string::npos) << message;
    EXPECT_EQ(threadCount(), 1);
    setThreadCount(2);
    EXPECT_EQ(rangesAtOnce(), 2);
    setThreadCount(1);
}

TEST(Parallel, EveryIndexIsVisitedOnceInOneLoopAfterTheOther)
{
    setThreadCount(3);
    std::vector<int> visits(500, 0);
    for (std::size_t loop = 0; loop < 3000; ++loop) {
        const std::size_t count = loop % visits.size();
        forEach(count, 1 + loop % 7, [&](std::size_t i) { ++visits[i]; });
        EXPECT_TRUE(std::all_of(visits.begin(), visits.begin() + static_cast<std::ptrdiff_t>(count),
                                [](int n) { return n == 1; }));
        std::fill(visits.begin(), visits.end(), 0);
    }
    setThreadCount(1);
}

// What a thread wrote in one loop is in its cache in the next.
TEST(Parallel, EachThreadBeginsWithTheSameShareInEveryLoop)
{
    setThreadCount(2);
    std::array<std::thread::id, 2> first;
    for (int loop = 0; loop < 50; ++loop) {
        std::array<std::thread::id, 2> ids;
        std::atomic<int> begun = 0;
        forEach(2, 1, [&](std::size_t i) {
            ids[i] = std::this_thread::get_id();
            ++begun;
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
            while (begun < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        });
        if (loop == 0) first = ids;
        EXPECT_EQ(ids, first);
    }
    EXPECT_EQ(first[0], std::this_thread::get_id());
    setThreadCount(1);
}

TEST(Parallel, WhatARangeThrowsComesOutOfTheLoopAndTheNextOneIsWhole)
{
    setThreadCount(2);
    for (std::size_t bad = 0; bad < 100; ++bad) {
        EXPECT_THROW(forEach(100, 1,
                             [&](std::size_t i) {
                                 if (i == bad) throw Error(ErrorKind::badInput, "in a range");
                             }),
                     Error);
        std::atomic<int> done = 0;
        forEach(100, 1, [&](std::size_t) { ++done; });
        EXPECT_EQ(done, 100);
    }
    setThreadCount(1);
}

TEST(Parallel, ALoopInsideOfARangeIsDoneByItsThread)
{
    setThreadCount(2);
    std::atomic<int> done = 0, elsewhere = 0;
    forEach(20, 1, [&](std::size_t) {
        const std::thread::id here = std::this_thread::get_id();
        forEach(10, 1, [&](std::size_t) {
            ++done;
            elsewhere += std::this_thread::get_id() != here;
        });
    });
    EXPECT_EQ(done, 200);
    EXPECT_EQ(elsewhere, 0);
    setThreadCount(1);
}

// A chain on every tenth item, and each item also on the one before it in its half.
TEST(Parallel, WorkInOrderIsDoneOnceAndNeverBeforeWhatItFollows)
{
    setThreadCount(4);
    constexpr std::uint32_t kItems = 4000;
    WorkOrder order{std::vector(kItems, std::array{WorkOrder::kNone, WorkOrder::kNone}),
                    std::vector<std::uint8_t>(kItems, 0)};
    for (std::uint32_t i = 0; i < kItems; ++i) {
        const std::array<std::uint32_t, 2> later = {i + 10, i + 2};
        for (int f = 0; f < 2; ++f) {
            if (later[f] >= kItems) continue;
            order.followers[i][f] = later[f];
            ++order.predecessors[later[f]];
        }
    }
    std::vector<std::atomic<int>> done(kItems);
    std::atomic<int> tooEarly = 0;
    parallelInOrder(order, [&](std::size_t i) {
        for (const std::size_t before : {i - 10, i - 2}) {
            if (before < kItems && done[before] != 1) ++tooEarly;
        }
        ++done[i];
    });
    EXPECT_EQ(tooEarly, 0);
    EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](const auto& n) { return n == 1; }));
    setThreadCount(1);
}

}  // namespace
}  // namespace scree::test
