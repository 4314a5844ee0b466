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
}

TEST_P(BlenderTest, AFastSpinnerBlursByTheAngleItTurns)
{
    makeExport("");
    check("blur " + cacheAndTake() + " box_1");
}

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
