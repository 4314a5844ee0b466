// [[import]] with motion = "keyed": bodies of a shot stand at every frame where the file has them.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/base/error.h"
#include "io/frame_writer.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001, kFrames = 5;

/// Where "mover" is `frames` after the first one; defined for samples before it too.
Pose moverAt(double frames)
{
    return test::tumblingPose(0, frames + 1.0);
}

/// A file whose bodies "mover" tumbles from frame to frame and "still" never moves, both there from
/// the first frame on, as a take says it.
void writeAsset(const std::filesystem::path& output, const std::vector<double>& offsets = {0.0})
{
    SceneDescription scene =
        test::sceneOf({test::bodyNamed("mover"), test::bodyNamed("still", false)});
    for (SceneBody& body : scene.bodies) body.birthFrame = kFirst;
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, kFrames, offsets);
    for (int i = 0; i < kFrames; ++i) {
        for (const double offset : offsets) {
            SceneFrame sample =
                test::frameWith(kFirst + i, {moverAt(i + offset), test::tumblingPose(1, 0.0)});
            sample.offset = offset;
            writer->write(sample);
        }
    }
    writer->finish();
}

std::string shotText(const std::string& file, const std::string& nodes, const std::string& more)
{
    return "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1005\"\n[material.wood]\n[[import]]\n"
           "file = \"" +
           file + "\"\nmaterial = \"wood\"\nnodes = \"" + nodes + "\"\nmotion = \"keyed\"\n" + more;
}

class KeyedImport : public testing::TestWithParam<const char*> {};

TEST_P(KeyedImport, BodiesStandAtEveryFrameWhereTheFileHasThem)
{
    const test::TemporaryFolder folder;
    for (const std::vector<double>& offsets : {std::vector{0.0}, std::vector{-0.25, 0.0, 0.25}}) {
        writeAsset(folder / GetParam(), offsets);
        const Shot shot = parseShotText(shotText(folder / GetParam(), "*", ""), "s.toml");
        ASSERT_EQ(shot.bodies.size(), 2u);
        EXPECT_EQ(shot.bodies[0].kind, BodyKind::keyed);
        const MotionScript moverScript(shot.bodies[0].keys, shot.bodies[0].interpolation);
        const MotionScript stillScript(shot.bodies[1].keys, shot.bodies[1].interpolation);
        for (int i = 0; i < kFrames; ++i) {
            const double time = i / shot.framesPerSecond;
            const Pose mover = moverScript.at(time), still = stillScript.at(time);
            // Quaternions and places in single precision; times of glTF are, too: 6e-8 of the
            // speed.
            const Pose expected = moverAt(i);
            EXPECT_LT((mover.position - expected.position).norm(), 1e-5) << "frame " << i;
            EXPECT_LT(mover.orientation.angularDistance(expected.orientation), 1e-5);
            EXPECT_LT((still.position - test::tumblingPose(1, 0.0).position).norm(), 1e-5);
        }
        // Half way between two samples it is half way from the one to the other.
        const double step = offsets.back() > 0.0 ? 0.5 : 1.0;
        const Pose before = moverAt(2.5 - 0.5 * step), after = moverAt(2.5 + 0.5 * step);
        const Pose between = moverScript.at(2.5 / shot.framesPerSecond);
        EXPECT_LT((between.position - 0.5 * (before.position + after.position)).norm(), 1e-5);
    }
}

TEST_P(KeyedImport, AFileThatMovesNothingIsRefused)
{
    const test::TemporaryFolder folder;
    writeAsset(folder / GetParam());
    const std::string message = test::messageOfShot(shotText(folder / GetParam(), "*still*", ""));
    EXPECT_NE(message.find("s.toml:10:10: the file animates none of these nodes; motion = "
                           "\"static\""),
              std::string::npos)
        << message;
}

INSTANTIATE_TEST_SUITE_P(Formats, KeyedImport, testing::Values("x.glb", "x.abc"));

TEST(KeyedImports, ScaleThatChangesIsRefused)
{
    const test::TemporaryFolder folder;
    // A body that is born late: glTF knows no visibility, so it grows from nothing.
    SceneDescription scene = test::sceneOf({test::bodyNamed("late")});
    scene.bodies[0].birthFrame = kFirst + 2;
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(folder / "x.glb");
    writer->begin(scene, kFirst, kFrames);
    for (int i = 0; i < kFrames; ++i) writer->write(test::tumblingFrame(scene, kFirst + i, kFirst));
    writer->finish();
    const std::string message = test::messageOfShot(shotText(folder / "x.glb", "*", ""));
    EXPECT_NE(message.find("'late' cannot be keyed: its scale changes over time"),
              std::string::npos)
        << message;
}

}  // namespace
}  // namespace scree
