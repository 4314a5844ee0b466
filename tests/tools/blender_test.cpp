// Blender opens what we export and sees what was simulated (tests/support/blender_check.py).
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/readers.h"

namespace scree {
namespace {

// A box that spins fast about z, a ring that tumbles; in flight, so that nothing stands still.
constexpr const char* kShotText = R"(
scree = 1
[shot]
name = "spin"
frames = "1001-1012"
[material.paint]
density = 650
color = [0.7, 0.1, 0.05]
[shape.box]
box = { size = [2, 0.3, 0.5] }
[shape.ring]
torus = { major = 0.6, minor = 0.2 }
[[body]]
name = "box_1"
shape = "box"
material = "paint"
position = [0, 4, 0]
spin = [0, 0, 2000]
[[body]]
name = "ring_1"
shape = "ring"
material = "paint"
position = [3, 2, 0]
rotation = [10, 20, 30]
velocity = [1, 2, 0]
spin = [100, 200, 0]
[[camera]]
name = "main"
eye = [3, 4, 14]
target = [1, 2.5, 0]
fov = 32
[render]
size = [480, 270]
[output]
subframes = [-0.25, 0.0, 0.25]
)";

/// Simulates once, exports, and asks Blender.
class BlenderTest : public testing::TestWithParam<const char*> {
protected:
    static void run(const std::string& command)
    {
        const test::CommandResult result = test::runCommand(command);
        ASSERT_EQ(result.exitCode, 0) << command << "\n" << result.output;
    }

    void makeExport(const std::string& settings, const std::string& shotText = kShotText)
    {
        const std::string program = test::quoted(SCREE_PROGRAM);
        std::ofstream(folder / "spin.toml") << shotText;
        run(program + " sim " + test::quoted(folder / "spin.toml") + " -q -o " +
            test::quoted(take()) + settings);
        run(program + " export -q " + test::quoted(take()) + " -o " + test::quoted(cache()));
    }

    std::filesystem::path take() const { return folder / "take"; }
    std::filesystem::path cache() const { return folder / ("spin." + std::string(GetParam())); }

    void check(const std::string& claim)
    {
        const test::Reader& blender = test::findReader("blender");
        SCREE_REQUIRE_READER(!blender.command.empty(), blender.reason);
        run(test::quoted(blender.command) + " " +
            test::quoted(test::sourceFile("tests/support/blender_check.py")) + " " + claim);
    }

    std::string cacheAndTake() const { return test::quoted(cache()) + " " + test::quoted(take()); }

    test::TemporaryFolder folder;
};

TEST_P(BlenderTest, EveryBodyIsWhereTheTakeHasItAlsoBetweenFrames)
{
    makeExport("");
    check("poses " + cacheAndTake());
}

TEST_P(BlenderTest, AZUpShotStandsUpright)
{
    makeExport(" --set 'shot.up=\"+z\"' --set 'shot.gravity=[0,0,-9.81]'");
    check("poses " + cacheAndTake());
    check("camera " + cacheAndTake());
}

TEST_P(BlenderTest, TheCameraSeesWhatTheShotsCameraSees)
{
    makeExport("");
    check("camera " + cacheAndTake());
}

TEST_P(BlenderTest, AKeyedCameraMovesAsInTheShot)
{
    std::string text = kShotText;
    const std::string still = "eye = [3, 4, 14]";
    text.replace(text.find(still), still.size(),
                 "keys = [{ frame = 1001, eye = [3, 4, 14] }, { frame = 1005, eye = [9, 4, 8] }, "
                 "{ frame = 1012, eye = [9, 6, 8], target = [0, 2, 0] }]\n"
                 "interpolate = \"linear\"");
    makeExport("", text);
    check("camera " + cacheAndTake());
    check("camera " + test::quoted(take()) + " " + test::quoted(take()));
}

// Blender reads no visibility: coins that had yet to be poured hung in the air, and in a take that
// was opened as it is what has keys stood still.
TEST_P(BlenderTest, NobodyIsSeenBeforeItsBirthOrWhenHiddenAndWhatHasKeysMoves)
{
    std::string text = kShotText;
    text.replace(text.find("subframes"), std::string::npos, "contacts = false\n");
    makeExport("", text +
                       "[[body]]\nname = \"pusher\"\nshape = \"box\"\nmaterial = \"paint\"\n"
                       "motion = \"keyed\"\nkeys = [{ frame = 1001, position = [9, 0, 0] }, "
                       "{ frame = 1012, position = [9, 5, 0] }]\n"
                       "[[body]]\nname = \"proxy\"\nshape = \"box\"\nmaterial = \"paint\"\n"
                       "motion = \"static\"\nposition = [0, -9, 0]\nvisible = false\n"
                       "[[body]]\nname = \"ghost\"\nshape = \"box\"\nmaterial = \"paint\"\n"
                       "position = [20, 0, 0]\nvisible = false\n"
                       "[[emitter]]\nname = \"coin\"\nshape = \"ring\"\nmaterial = \"paint\"\n"
                       "count = 4\nframes = \"1001-1010\"\n"
                       "box = { min = [-9, 3, -1], max = [-5, 9, 1] }\n");
    check("births " + cacheAndTake());
    check("births " + test::quoted(take()) + " " + test::quoted(take()));
}

TEST_P(BlenderTest, AFastSpinnerBlursByTheAngleItTurns)
{
    makeExport("");
    check("blur " + cacheAndTake() + " box_1");
}

/// A box with texture coordinates, of which no two corners have the same.
void writePaintedBox(const std::filesystem::path& path)
{
    std::ofstream file(path);
    file << "v -1 -0.2 -0.3\nv 1 -0.2 -0.3\nv 1 0.2 -0.3\nv -1 0.2 -0.3\n"
            "v -1 -0.2 0.3\nv 1 -0.2 0.3\nv 1 0.2 0.3\nv -1 0.2 0.3\n";
    for (int corner = 0; corner < 24; ++corner) {
        file << "vt " << corner / 32.0 << " " << (corner % 5) / 8.0 << "\n";
    }
    const int faces[6][4] = {{4, 3, 2, 1}, {5, 6, 7, 8}, {1, 2, 6, 5},
                             {3, 4, 8, 7}, {2, 3, 7, 6}, {4, 1, 5, 8}};
    int corner = 0;
    for (const auto& face : faces) {
        file << "f";
        for (const int point : face) file << " " << point << "/" << ++corner;
        file << "\n";
    }
}

class BlenderTextures : public BlenderTest {};

TEST_P(BlenderTextures, EveryCornerShowsWhatTheAssetsCornerShows)
{
    writePaintedBox(folder / "painted.obj");
    std::ofstream(folder / "painted.toml")
        << "scree = 1\n[shot]\nname = \"painted\"\nframes = \"1001-1002\"\n[material.paint]\n"
           "[shape.box]\nfile = \"painted.obj\"\n[[body]]\nname = \"box\"\nshape = \"box\"\n"
           "material = \"paint\"\nmotion = \"static\"\nposition = [1, 2, 3]\n"
           "rotation = [10, 20, 30]\n";
    const std::string program = test::quoted(SCREE_PROGRAM);
    run(program + " sim -q " + test::quoted(folder / "painted.toml") + " -o " +
        test::quoted(take()));
    std::string exports;
    for (const std::string name : {"x.abc", "x.usda", "x.glb", "x.####.obj"}) {
        run(program + " export -q " + test::quoted(take()) + " -o " + test::quoted(folder / name));
        exports += " " + test::quoted(folder / (name == "x.####.obj" ? "x.1001.obj" : name));
    }
    check("textures " + test::quoted(take()) + " " + test::quoted(folder / "painted.obj") +
          exports);
}

INSTANTIATE_TEST_SUITE_P(AllFormats, BlenderTextures, testing::Values("all"));

INSTANTIATE_TEST_SUITE_P(Exports, BlenderTest, testing::Values("abc", "usda"));

class BlenderShading : public BlenderTest {};

TEST_P(BlenderShading, BoxesAreFlatRingsAreSmoothAndMaterialsHaveTheirNames)
{
    makeExport("");
    check("shading " + test::quoted(cache()));
}

INSTANTIATE_TEST_SUITE_P(Alembic, BlenderShading, testing::Values("abc"));

}  // namespace
}  // namespace scree
