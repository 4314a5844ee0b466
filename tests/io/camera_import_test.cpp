// [[camera]] file: the camera of an asset is where other programs show it.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/scene/camera_motion.h"
#include "io/frame_writer.h"
#include "io/shot_parser.h"
#include "tests/support/export_scene.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kFirst = 1001, kFrames = 5;

/// One that never moves, and one that goes around.
std::vector<SceneCamera> someCameras()
{
    SceneCamera still;
    still.name = "still";
    still.eye = {3.0, 4.0, 12.0};
    still.target = {0.5, 2.0, -1.0};
    still.fovDegrees = 28.0;
    SceneCamera around;
    around.name = "around";
    around.orbit = CameraOrbit{{0.0, 1.0, 0.0}, 8.0, 3.0, 0.0, 120.0, 1001.0, 1005.0};
    return {still, around};
}

void writeAsset(const std::filesystem::path& output)
{
    SceneDescription scene = test::sceneOf({test::bodyNamed("mover")});
    scene.cameras = someCameras();
    const std::unique_ptr<FrameWriter> writer = makeFrameWriter(output);
    writer->begin(scene, kFirst, kFrames);
    for (int i = 0; i < kFrames; ++i) {
        writer->write(test::frameWith(kFirst + i, {test::tumblingPose(0, i)}));
    }
    writer->finish();
}

std::string shotText(const std::string& file, const std::string& lines)
{
    return "scree = 1\n[shot]\nname = \"s\"\nframes = \"1001-1005\"\n[[camera]]\nfile = \"" + file +
           "\"\n" + lines;
}

std::string messageOf(const std::string& text)
{
    try {
        parseShotText(text, "s.toml");
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

class CameraImport : public testing::TestWithParam<const char*> {};

TEST_P(CameraImport, StandsAndLooksAtEveryFrameAsTheFileHasIt)
{
    const test::TemporaryFolder folder;
    writeAsset(folder / GetParam());
    for (const SceneCamera& expected : someCameras()) {
        const Shot shot = parseShotText(
            shotText(folder / GetParam(), "node = \"" + expected.name + "*\"\n"), "s.toml");
        ASSERT_EQ(shot.cameras.size(), 1u);
        EXPECT_EQ(shot.cameras[0].name, "main");
        EXPECT_EQ(moves(shot.cameras[0]), moves(expected));
        for (int frame = kFirst; frame < kFirst + kFrames; ++frame) {
            const SceneCamera have = cameraAt(shot.cameras[0], frame, false);
            const SceneCamera want = cameraAt(expected, frame, false);
            // Coordinates pass through single precision in a glb.
            EXPECT_TRUE(have.eye.isApprox(want.eye, 1e-5)) << frame << ": " << have.eye.transpose();
            const Vec3 way = (have.target - have.eye).normalized();
            const Vec3 wanted = (want.target - want.eye).normalized();
            EXPECT_LT((way - wanted).norm(), 1e-5) << frame;
            EXPECT_NEAR(have.fovDegrees, want.fovDegrees, 1e-3);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, CameraImport, testing::Values("a.glb", "a.abc"),
                         [](const auto& one) { return std::string(one.param).substr(2); });

TEST(CameraImport, SaysWhichCamerasThereAreAndRefusesWhatTheFileDecides)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.abc";
    writeAsset(path);
    EXPECT_EQ(messageOf(shotText(path, "node = \"arond\"\n")),
              "s.toml:7:8: no camera of '" + path +
                  "' is called \"arond\"; did you mean 'around'? (it has: still, around)");
    EXPECT_EQ(
        messageOf("scree = 1\n[shot]\nname = \"s\"\n[[camera]]\neye = [1, 2, 3]\nnode = \"a\"\n"),
        "s.toml:6:8: 'node' chooses a camera of a 'file', and there is none");
    EXPECT_NE(messageOf(shotText(path, "eye = [1, 2, 3]\n")).find("'eye'"), std::string::npos);
    EXPECT_NE(messageOf(shotText(path, "fov = 30\n")).find("'fov'"), std::string::npos);
}

}  // namespace
}  // namespace scree
