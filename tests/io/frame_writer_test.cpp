#include "io/frame_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/support/export_scene.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

/// Keeps nothing: only the checks that all formats share are under test.
class SilentWriter final : public FrameWriter {
    void beginScene(const SceneDescription&, int, int) override {}
    void writeFrame(const SceneFrame&) override {}
    void finishScene(const FinishWatch&) override {}
};

template <class Action>
std::string messageOf(ErrorKind kind, Action action)
{
    const test::Refusal refusal = test::refusalBy(action);
    EXPECT_EQ(refusal.kind, kind) << refusal.message;
    return refusal.message;
}

TEST(FrameWriter, AnUnknownEndingIsAnsweredWithTheKnownOnes)
{
    const std::string message =
        messageOf(ErrorKind::usage, [] { makeFrameWriter("out/cache.abx"); });
    for (const char* ending : {".abc", ".obj", ".ply"}) {
        EXPECT_NE(message.find(ending), std::string::npos) << message;
    }
}

TEST(FrameWriter, EndingsAreKnownInAnyCase)
{
    EXPECT_NE(makeFrameWriter("CACHE.ABC"), nullptr);
    EXPECT_NE(makeFrameWriter("cache.$F4.Obj"), nullptr);
}

TEST(FrameWriter, SequencesNeedAPlaceForTheFrameNumberAndCachesNone)
{
    const std::string message = messageOf(ErrorKind::usage, [] { makeFrameWriter("x.ply"); });
    EXPECT_NE(message.find("x.####.ply"), std::string::npos) << message;
    messageOf(ErrorKind::usage, [] { makeFrameWriter("x.####.abc"); });
}

TEST(FrameWriter, APoseNeedsNoPlaceForTheFrameNumber)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    for (const char* name : {"x.obj", "x.ply", "x.pov", "x.glb"}) {
        const auto writer = makePoseWriter(folder / name);
        writer->begin(scene, 1, 1);
        writer->write(test::tumblingFrame(scene, 1, 1));
        writer->finish();
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
    messageOf(ErrorKind::usage, [] { makePoseWriter("x.fbx"); });
}

// It worked on for minutes after the last frame, and could not be asked to stop.
TEST(FrameWriter, TheEndTellsHowFarItIsAndCanBeBrokenOff)
{
    const SceneDescription scene = test::sceneOf(
        {test::bodyNamed("a"), test::bodyNamed("b"), test::bodyNamed("c"), test::bodyNamed("d")});
    for (const char* name : {"x.usda", "x.instances.usda", "x.glb", "x.abc"}) {
        const test::TemporaryFolder folder;
        const auto write = [&](const FinishWatch& watch) {
            const auto writer = makeFrameWriter(folder / name);
            writer->begin(scene, 1, 3);
            for (int frame = 1; frame <= 3; ++frame)
                writer->write(test::tumblingFrame(scene, frame, 1));
            writer->finish(watch);
        };
        std::vector<double> shares;
        struct Enough {};
        EXPECT_THROW(write([&](double share) {
                         shares.push_back(share);
                         if (share > 0.4) throw Enough();
                     }),
                     Enough)
            << name;
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
        ASSERT_GT(shares.size(), 1u) << name;
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << name;
        write([&](double share) { EXPECT_LE(share, 1.0) << name; });
        EXPECT_TRUE(std::filesystem::exists(folder / name));
    }
}

TEST(FrameWriter, AFolderThatDoesNotExistIsFoundBeforeTheFirstFrame)
{
    const test::TemporaryFolder folder;
    const SceneDescription scene = test::sceneOf({test::bodyNamed("ring")});
    for (const char* name : {"missing/x.abc", "missing/x.####.obj", "missing/x.####.ply"}) {
        messageOf(ErrorKind::cannotCreate,
                  [&] { makeFrameWriter(folder / name)->begin(scene, 1, 1); });
    }
}

TEST(FrameWriter, NamesThatFormatsCannotHoldAreRefused)
{
    for (const char* name : {"", "a/b", "a b", "a.b", "a:b", "a;b", "a=b", "bröd", "a\nb"}) {
        const SceneDescription scene = test::sceneOf({test::bodyNamed(name)});
        messageOf(ErrorKind::badInput, [&] { SilentWriter().begin(scene, 1, 1); });
    }
    SceneDescription scene = test::sceneOf({});
    scene.name = "my shot";
    messageOf(ErrorKind::badInput, [&] { SilentWriter().begin(scene, 1, 1); });
}

TEST(FrameWriter, TwoBodiesOfOneNameAreRefused)
{
    const SceneDescription scene = test::sceneOf({test::bodyNamed("a"), test::bodyNamed("a")});
    messageOf(ErrorKind::badInput, [&] { SilentWriter().begin(scene, 1, 1); });
}

TEST(FrameWriter, ANonFinitePoseIsNamedWithBodyAndFrame)
{
    const SceneDescription scene = test::sceneOf({test::bodyNamed("a"), test::bodyNamed("lost")});
    SceneFrame frame = test::tumblingFrame(scene, 7, 7);
    frame.worldFromAsset[1].position.y() = std::numeric_limits<double>::quiet_NaN();
    SilentWriter writer;
    writer.begin(scene, 7, 1);
    const std::string message = messageOf(ErrorKind::qualityLimit, [&] { writer.write(frame); });
    EXPECT_NE(message.find("lost"), std::string::npos) << message;
    EXPECT_NE(message.find("frame 7"), std::string::npos) << message;
}

// GLB said null of it, USD inf.
TEST(FrameWriter, WhatSinglePrecisionCannotHoldIsNamedWithBodyAndFrame)
{
    const SceneDescription scene = test::sceneOf({test::bodyNamed("a"), test::bodyNamed("far")});
    for (const double far : {3.3e38, -3.5e38}) {
        SceneFrame frame = test::tumblingFrame(scene, 7, 7);
        frame.worldFromAsset[1].position.y() = far;
        SilentWriter writer;
        writer.begin(scene, 7, 1);
        if (far > 0.0) {
            writer.write(frame);
            continue;
        }
        const std::string message =
            messageOf(ErrorKind::qualityLimit, [&] { writer.write(frame); });
        EXPECT_NE(message.find("frame 7: pose or velocity of \"far\""), std::string::npos)
            << message;
        EXPECT_NE(message.find("3.4e38"), std::string::npos) << message;
    }
}

TEST(FrameWriter, GapsAndMissingFramesAreOurOwnMistakes)
{
    const SceneDescription scene = test::sceneOf({test::bodyNamed("a")});
    SilentWriter writer;
    writer.begin(scene, 7, 2);
    writer.write(test::tumblingFrame(scene, 7, 7));
    messageOf(ErrorKind::internal, [&] { writer.finish(); });
    messageOf(ErrorKind::internal, [&] { writer.write(test::tumblingFrame(scene, 9, 7)); });
    writer.write(test::tumblingFrame(scene, 8, 7));
    EXPECT_NO_THROW(writer.finish());
}

}  // namespace
}  // namespace scree
