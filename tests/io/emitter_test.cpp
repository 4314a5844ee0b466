// Emitters: exact counts, draws that depend on nothing but themselves, and births that reach takes
// and every cache.
#include "io/emitter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "tests/support/abc_check.h"
#include "tests/support/export_scene.h"
#include "tests/support/readers.h"
#include "tests/support/refusal.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

const std::string kHead = R"(
scree = 1
[shot]
name = "emitted"
frames = "1001-1012"
[material.wood]
density = 650
[shape.block]
box = {}
[shape.ball]
sphere = { radius = 0.5, subdivisions = 1 }
)";

std::string emitter(const std::string& name, const std::string& lines)
{
    return "[[emitter]]\nname = \"" + name + "\"\nmaterial = \"wood\"\n" + lines;
}

Shot parse(const std::string& text)
{
    return parseShotText(kHead + text, "emitted.toml");
}

const std::string kManyDraws =
    "shape = [\"block\", \"ball\"]\nweights = [3, 1]\ncount = 1000\nframes = \"1003-1007\"\n"
    "box = { min = [-8, 10, -8], max = [8, 14, 8] }\ntilt = \"random\"\n";

TEST(Emitter, MakesExactlyItsCountAndSpreadsTheBirthsEvenly)
{
    const Shot shot = parse(emitter("e", kManyDraws));
    ASSERT_EQ(shot.bodies.size(), 1000u);
    EXPECT_EQ(shot.bodies[7].name, "e_0007");
    std::map<int, int> births;
    int blocks = 0;
    Vec3 mean = Vec3::Zero(), up = Vec3::Zero();
    for (const ShotBody& body : shot.bodies) {
        ++births[body.birth->frame];
        blocks += *body.shape == "block";
        mean += body.worldFromAsset.position / 1000.0;
        up += body.worldFromAsset.orientation * Vec3::UnitY() / 1000.0;
        EXPECT_TRUE((body.worldFromAsset.position.array() >= Vec3(-8, 10, -8).array()).all());
        EXPECT_TRUE((body.worldFromAsset.position.array() < Vec3(8, 14, 8).array()).all());
    }
    EXPECT_EQ(births, (std::map<int, int>{
                          {1003, 200}, {1004, 200}, {1005, 200}, {1006, 200}, {1007, 200}}));
    // Four standard deviations of a thousand draws.
    EXPECT_NEAR(blocks, 750, 55);
    EXPECT_LT((mean - Vec3(0, 12, 0)).cwiseAbs().maxCoeff(), 0.6);
    EXPECT_LT(up.cwiseAbs().maxCoeff(), 0.075) << "no direction is favoured";
}

TEST(Emitter, DrawsDoNotDependOnOtherEmitters)
{
    const Shot alone = parse(emitter("e", kManyDraws));
    const Shot second = parse(emitter("other", kManyDraws) + emitter("e", kManyDraws));
    const Pose &a = alone.bodies[3].worldFromAsset, &b = second.bodies[1003].worldFromAsset;
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.orientation.coeffs(), b.orientation.coeffs());
    EXPECT_NE(a.position, second.bodies[3].worldFromAsset.position) << "names decide too";
}

TEST(Emitter, ALayoutIsFilledPlaceAfterPlaceAndTiltIsALimit)
{
    const Shot shot = parse(emitter("e",
                                    "shape = \"block\"\ncount = 5\ntilt = 10\n"
                                    "layout = { position = [0, 3, 0], grid = { count = [2, 1, 1], "
                                    "spacing = [4, 0, 0] } }\n"));
    const double places[] = {-2.0, 2.0, -2.0, 2.0, -2.0};
    double largest = 0.0;
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(shot.bodies[i].worldFromAsset.position, Vec3(places[i], 3.0, 0.0));
        EXPECT_EQ(shot.bodies[i].birth->frame, 1001);
        const Vec3 up = shot.bodies[i].worldFromAsset.orientation * Vec3::UnitY();
        largest = std::max(largest, std::acos(up.y()) * 180.0 / 3.14159265358979);
    }
    EXPECT_LE(largest, 10.0);
    EXPECT_GT(largest, 1.0);
}

TEST(Emitter, ItsBodiesHaveItsGroup)
{
    const Shot shot = parseShotText(
        test::shotTextOf({}, test::bodyText("hero", "unmoved_by = [\"debris\"]") +
                                 "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = "
                                 "\"wood\"\ncount = 2\ngroup = \"debris\"\ncollides = []\n"
                                 "box = { min = [0, 5, 0], max = [9, 9, 9] }\n"),
        "s.toml");
    ASSERT_EQ(shot.bodies.size(), 4u);
    for (const std::size_t emitted : {2, 3}) {
        EXPECT_EQ(shot.bodies[emitted].groups.group, shot.bodies[1].groups.unmovedBy);
        EXPECT_EQ(shot.bodies[emitted].groups.collidesWith, 0u);
    }
}

TEST(Emitter, AFailingBirthAtTheFirstFrameIsALocatedError)
{
    const Shot shot = parse(emitter("e",
                                    "shape = \"block\"\ncount = 2\nclear = \"fail\"\n"
                                    "box = { min = [0, 0, 0], max = [0, 0, 0] }\n"));
    const test::Refusal refusal = test::refusalBy([&] { buildWorld(shot); });
    EXPECT_EQ(refusal.message,
              "emitted.toml:12:1: 'e_0001' cannot be born: 'e_0000' stands in its place; clear "
              "= \"wait\" lets it wait");
}

// Cubes that fall through one place, 5 frames apart or so, while the place is wanted every frame.
const std::string kQueue = emitter("e",
                                   "shape = \"block\"\ncount = 4\nframes = \"1001-1004\"\n"
                                   "box = { min = [0, 9, 0], max = [0, 9, 0] }\n"
                                   "velocity = [0, -6, 0]\n");

void simulate(TakeWriter& take, const Shot& shot, World& world, int lastFrame, bool stopsInside)
{
    Stepper stepper(shot.settings);
    if (!take.hasFrame(shot.firstFrame)) {
        FrameStats stats;
        stats.frame = shot.firstFrame;
        take.writeFrame(world, stats);
    }
    for (int frame = shot.firstFrame + 1; frame <= lastFrame; ++frame) {
        if (take.hasFrame(frame)) continue;
        take.prepareFor(frame, world);
        FrameStats stats;
        stats.frame = frame;
        const bool stops = stopsInside && frame == lastFrame;
        stats.report = stepper.advanceFrame(world, 1.0 / 24.0, [&] { return stops; });
        if (!stats.report.finished) return take.writeCheckpoint(world);
        take.writeFrame(world, stats);
    }
}

using test::contentOf;

TEST(Emitter, ARunStoppedWhileBodiesWaitGoesOnToTheSameBytes)
{
    const test::TemporaryFolder folder;
    Shot shot = parse(kQueue);
    shot.settings.substeps.min = 8;  // so that there is an inside of a frame to stop in
    World whole = buildWorld(shot), before = buildWorld(shot), after = buildWorld(shot);
    {
        TakeWriter take(folder / "whole", shot, whole, "1", ExistingTake::refuse);
        simulate(take, shot, whole, 1012, false);
    }
    {
        TakeWriter take(folder / "cut", shot, before, "1", ExistingTake::refuse);
        simulate(take, shot, before, 1007, true);
        EXPECT_GT(before.clock.subStep, 0);
        EXPECT_EQ(before.bornAt[3], kUnborn) << "somebody waits";
    }
    {
        TakeWriter take(folder / "cut", shot, after, "1", ExistingTake::resume);
        simulate(take, shot, after, 1012, false);
    }
    for (int frame = 1001; frame <= 1012; ++frame) {
        EXPECT_EQ(readFileBytes(TakePaths{folder / "whole"}.frame(frame)),
                  readFileBytes(TakePaths{folder / "cut"}.frame(frame)))
            << frame;
    }

    // A reader of the take is told when each body came.
    const SceneDescription scene = TakeReader(folder / "cut").describe();
    EXPECT_EQ(scene.bodies[0].birthFrame, 1001);
    EXPECT_EQ(scene.bodies[1].birthFrame, 1001 + after.bornAt[1]);
    EXPECT_GT(scene.bodies[1].birthFrame, 1002);
    EXPECT_EQ(scene.bodies[3].birthFrame, kNeverBorn);
    EXPECT_GT(scene.bodies[3].mass, 0.0);
}

// The first of these is before the first frame.
const std::vector<double> kSubframes = {-0.25, 0.0, 0.25};

/// One body from the start, one born at the third of five frames, one never.
class EmittedExport : public testing::Test {
protected:
    EmittedExport()
        : scene(test::sceneOf(
              {test::bodyNamed("early"), test::bodyNamed("late"), test::bodyNamed("never")}))
    {
        scene.bodies[0].birthFrame = 1001;  // as a take says it of those that stand there
        scene.bodies[1].birthFrame = 1003;
        scene.bodies[2].birthFrame = kNeverBorn;
    }

    std::filesystem::path write(const std::string& name,
                                const std::vector<double>& offsets = {0.0}) const
    {
        const std::filesystem::path path = folder / name;
        const auto writer = makeFrameWriter(path);
        writer->begin(scene, 1001, 5, offsets);
        for (int frame = 1001; frame <= 1005; ++frame) {
            for (const double offset : offsets) {
                SceneFrame sample = test::tumblingFrame(scene, frame, 1000);
                sample.offset = offset;
                writer->write(sample);
            }
        }
        writer->finish();
        return path;
    }

    const test::TemporaryFolder folder;
    SceneDescription scene;
};

TEST_F(EmittedExport, AlembicHidesABodyUntilItsBirth)
{
    const test::CommandResult result = test::runAbcCheck(write("a.abc"), "--strict");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const std::string& tree = result.output;
    const std::size_t late = tree.find("/test_shot/late "), never = tree.find("/test_shot/never ");
    const std::string visible = "visible scalar int8_t samples=5";
    EXPECT_EQ(tree.substr(0, late).find(visible), std::string::npos) << tree;
    EXPECT_NE(tree.substr(late, never - late).find(visible), std::string::npos) << tree;
    EXPECT_NE(tree.substr(never).find("visible scalar int8_t samples=5 stored=1"),
              std::string::npos)
        << tree;
}

TEST_F(EmittedExport, AlembicNeverHidesABodyOfTheStartThoughSamplesBeginBeforeTheFirstFrame)
{
    const test::CommandResult result = test::runAbcCheck(write("a.abc", kSubframes), "--strict");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const std::string& tree = result.output;
    EXPECT_EQ(tree.substr(0, tree.find("/test_shot/late ")).find("visible"), std::string::npos);
    EXPECT_NE(tree.find("visible scalar int8_t samples=15"), std::string::npos) << tree;
}

TEST_F(EmittedExport, UsdItselfSaysWhoIsVisibleWhen)
{
    const test::Reader& reader = test::findReader("usd");
    SCREE_REQUIRE_READER(!reader.command.empty(), reader.reason);
    const std::string script = (folder / "visible.py").string();
    std::ofstream(script) << R"(
import sys
from pxr import Usd, UsdGeom
plain, instanced = (Usd.Stage.Open(path) for path in sys.argv[1:3])
times = 1000.75, 1001, 1002.25, 1003, 1005.25
for name in ("early", "late", "never"):
    prim = UsdGeom.Imageable(plain.GetPrimAtPath("/test_shot/" + name))
    print(name, *(int(prim.ComputeVisibility(t) == "inherited") for t in times))
instancer = UsdGeom.PointInstancer(instanced.GetPrimAtPath("/test_shot/Bodies"))
for t in times: print(*map(int, instancer.ComputeMaskAtTime(t) or [1, 1, 1]))
)";
    for (const std::vector<double>& offsets : {std::vector{0.0}, kSubframes}) {
        const test::CommandResult result = test::runCommand(
            reader.command + " " + script + " " + test::quoted(write("a.usda", offsets)) + " " +
            test::quoted(write("a.instances.usda", offsets)));
        EXPECT_EQ(result.output,
                  "early 1 1 1 1 1\nlate 0 0 0 1 1\nnever 0 0 0 0 0\n"
                  "1 0 0\n1 0 0\n1 0 0\n1 1 0\n1 1 0\n");
    }
}

/// Times [s] and values of a glTF file's scale tracks, by body.
struct ScaleTracks {
    std::map<std::string, std::vector<float>> times, scales;

    explicit ScaleTracks(const std::filesystem::path& path);
};

ScaleTracks::ScaleTracks(const std::filesystem::path& path)
{
    const std::string file = contentOf(path);
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, 4);
    const auto json = nlohmann::json::parse(file.substr(20, length));
    const std::string binary = file.substr(28 + length);
    const auto floats = [&](std::size_t accessor, int width) {
        const auto& a = json["accessors"][accessor];
        const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        std::vector<float> values(a["count"].get<std::size_t>() * width);
        std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                    values.size() * sizeof(float));
        return values;
    };
    for (const auto& channel : json["animations"][0]["channels"]) {
        if (channel["target"]["path"] != "scale") continue;
        const auto& sampler = json["animations"][0]["samplers"][channel["sampler"].get<int>()];
        const std::string name = json["nodes"][channel["target"]["node"].get<int>()]["name"];
        EXPECT_EQ(sampler["interpolation"], "STEP");
        times[name] = floats(sampler["input"], 1);
        scales[name] = floats(sampler["output"], 3);
    }
}

TEST_F(EmittedExport, GltfScalesABodyToNothingUntilItsBirth)
{
    for (const std::vector<double>& offsets : {std::vector{0.0}, kSubframes}) {
        ScaleTracks tracks(write("a.glb", offsets));
        EXPECT_EQ(tracks.times.count("early"), 0u);
        EXPECT_EQ(tracks.times["late"], (std::vector<float>{0.0f, 2.0f / 24.0f}));
        EXPECT_EQ(tracks.scales["late"], (std::vector<float>{0, 0, 0, 1, 1, 1}));
        EXPECT_EQ(tracks.scales["never"], (std::vector<float>{0, 0, 0}));
    }
}

TEST_F(EmittedExport, SequencesLeaveUnbornBodiesOut)
{
    write("a.####.obj");
    EXPECT_EQ(contentOf(folder / "a.1002.obj").find("o late"), std::string::npos);
    EXPECT_NE(contentOf(folder / "a.1003.obj").find("o late"), std::string::npos);
    const std::string last = readFileBytes(folder / "a.1005.obj");
    EXPECT_NE(last.find("o late"), std::string::npos);
    EXPECT_EQ(last.find("o never"), std::string::npos);
}

}  // namespace
}  // namespace scree
