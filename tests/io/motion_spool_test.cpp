#include "io/motion_spool.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "tests/support/cast.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// A normalised quaternion is another quaternion by its last bits.
constexpr double kTolerance = 1e-15;

TEST(MotionSpool, TracksHoldWhatFramesHeldHoweverSmallTheBlocksAre)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    const std::vector<std::size_t> bodies = {0, 3, 4, 5};
    // Room for no body, for three of four, for all.
    for (const std::size_t blockBytes : {1u, 3 * 7 * 104u, 1u << 20}) {
        MotionSpool spool(folder.path(), bodies, blockBytes);
        for (int frame = 1001; frame <= 1007; ++frame) spool.append(test::castFrame(scene, frame));

        std::size_t visited = 0;
        spool.visitTracks([&](std::size_t k, std::span<const MotionSample> track) {
            EXPECT_EQ(k, visited++);
            ASSERT_EQ(track.size(), 7u);
            for (std::size_t time = 0; time < track.size(); ++time) {
                const Pose expected = test::castPose(scene, bodies[k], spool.times()[time]);
                const Pose& pose = track[time].worldFromAsset;
                EXPECT_EQ(pose.position, expected.position);
                EXPECT_NEAR(std::abs(pose.orientation.dot(expected.orientation)), 1.0, kTolerance);
            }
        });
        EXPECT_EQ(visited, bodies.size());
    }
}

TEST(MotionSpool, OneTimeOfAllBodiesIsTheFrame)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    MotionSpool spool(folder.path(), {0, 5});
    for (int frame = 1001; frame <= 1004; ++frame) spool.append(test::castFrame(scene, frame));
    const SceneFrame frame = test::castFrame(scene, 1003);
    const std::vector<MotionSample> samples = spool.readTime(2);
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[1].worldFromAsset.position, frame.worldFromAsset[5].position);
    EXPECT_EQ(samples[1].velocity, frame.velocity[5]);
    EXPECT_EQ(samples[1].angularVelocity, frame.angularVelocity[5]);
}

TEST(MotionSpool, LeavesNoNameInTheFolder)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::castScene();
    MotionSpool spool(folder.path(), {0});
    spool.append(test::castFrame(scene, 1001));
    spool.readTime(0);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(NeededTimes, KeepTheEndsOfEveryRestAndDropItsMiddle)
{
    const auto needed = [](const std::vector<int>& values) {
        return neededTimes(values.size(),
                           [&](std::size_t i, std::size_t j) { return values[i] == values[j]; });
    };
    using Times = std::vector<std::size_t>;
    EXPECT_EQ(needed({1, 2, 3}), (Times{0, 1, 2}));
    EXPECT_EQ(needed({1, 2, 2, 2, 2, 3}), (Times{0, 1, 4, 5}));
    EXPECT_EQ(needed({2, 2, 2, 3, 3, 3}), (Times{0, 2, 3, 5}));
    EXPECT_EQ(needed({1, 2, 1}), (Times{0, 1, 2}));
    EXPECT_EQ(needed({5, 5, 5}), (Times{0}));
    EXPECT_EQ(needed({5}), (Times{0}));
    EXPECT_EQ(needed({}), (Times{}));
}

}  // namespace
}  // namespace scree
