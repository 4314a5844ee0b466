// What a farm and an artist ask of `scree render` and `scree movie`: parts of a range, cameras,
// looks, slates, blur, films with the right colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/take_reader.h"
#include "render/legend.h"
#include "tests/support/export_scene.h"
#include "tests/support/readers.h"
#include "tests/support/small_shot.h"
#include "tools/picture_file.h"
#include "tools/take_painter.h"

namespace scree::test {
namespace {

namespace fs = std::filesystem;

// A stack, and a box that flies past it; two cameras, of which one pans.
const std::string kShotText =
    test::shotTextOf(
        {.name = "looks",
         .frames = "1001-1008",
         .woodKeys = "friction = 0.5\ncolor = [0.6, 0.3, 0.1]\n"},
        test::bodyText("low", "position = [0, 0.5, 0]") +
            test::bodyText("high", "position = [0, 1.35, 0]", "lid") +
            test::bodyText("fast", "position = [-3, 3, 0]\nvelocity = [24, 0, 0]") +
            test::bodyText("asleep", "position = [-2.5, 0.5, 0]\nstart = \"asleep\"")) +
    R"([shape.lid]
box = { size = [0.7, 0.7, 0.7] }
[[camera]]
name = "still"
eye = [0, 2, 9]
target = [0, 1.5, 0]
[[camera]]
name = "pan"
keys = [{ frame = 1001, eye = [0, 2, 9], target = [0, 1.5, 0] },
        { frame = 1008, eye = [8, 2, 5], target = [0, 1.5, 0], fov = 50 }]
interpolate = "linear"
[render]
size = [160, 90]
burnin = false
[output]
contacts = true
)";

/// One take for all tests: they only look at it.
class RenderOptions : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = new TemporaryFolder();
        std::ofstream(*folder_ / "looks.toml") << kShotText;
        const CommandResult made =
            scree("sim " + quoted(*folder_ / "looks.toml") + " -q -o " + quoted(take()));
        ASSERT_EQ(made.exitCode, 0) << made.output;
    }
    static void TearDownTestSuite()
    {
        delete folder_;
        folder_ = nullptr;
    }

    static fs::path take() { return *folder_ / "take"; }

    static CommandResult scree(const std::string& arguments)
    {
        return runCommand(quoted(SCREE_PROGRAM) + " " + arguments);
    }

    /// Renders into a folder of its own.
    CommandResult render(const std::string& arguments) const
    {
        return scree("render -q " + quoted(take()) + " -o " + quoted(pictures / "p.####.png") +
                     " " + arguments);
    }

    Image picture(int frame) const
    {
        return readPng(pictures / ("p." + std::to_string(frame) + ".png")).image;
    }

    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(pictures.path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    TemporaryFolder pictures;

private:
    static TemporaryFolder* folder_;
};

TemporaryFolder* RenderOptions::folder_ = nullptr;

/// Mean difference of two pictures of one size [linear].
double difference(const Image& a, const Image& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) sum += std::abs(a.values[i] - b.values[i]);
    return sum / static_cast<double>(a.values.size());
}

Color meanOf(const Image& image)
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += image.at(x, y).cast<double>();
    return (sum / (image.width * image.height)).cast<float>();
}

TEST_F(RenderOptions, ChunksOfAFarmAreTheWholeRangeAndOnlyTheFirstWritesTheSlate)
{
    ASSERT_EQ(render("--frames 1001-1008 --chunk 2/3 --slate").exitCode, 0);
    EXPECT_EQ(files(), (std::vector<std::string>{"p.1003.png", "p.1004.png", "p.1005.png"}));
    ASSERT_EQ(render("--frames 1001-1008 --chunk 1/3 --slate").exitCode, 0);
    ASSERT_EQ(render("--frames 1001-1008 --chunk 3/3 --slate").exitCode, 0);
    std::vector<std::string> all;
    for (int frame = 1000; frame <= 1008; ++frame)
        all.push_back("p." + std::to_string(frame) + ".png");
    EXPECT_EQ(files(), all);
    // A card: dark, with light words, and unlike the picture after it.
    const Image slate = picture(1000);
    EXPECT_LT(slate.at(slate.width - 1, 0).maxCoeff(), 0.05f);
    EXPECT_GT(*std::max_element(slate.values.begin(), slate.values.end()), 0.8f);
    for (const char* wrong : {"0/3", "4/3", "2", "2/3x", "-1/3"})
        EXPECT_EQ(render(std::string("--chunk ") + wrong).exitCode, 64) << wrong;
}

TEST_F(RenderOptions, SkipExistingDrawsWhatIsMissingOrOlderThanItsFrame)
{
    ASSERT_EQ(render("--frames 1001-1003").exitCode, 0);
    const fs::path kept = pictures / "p.1001.png", old = pictures / "p.1002.png";
    const auto drawn = fs::last_write_time(kept) - std::chrono::milliseconds(1);
    fs::last_write_time(kept, drawn);
    std::ofstream(old) << "old";
    const auto simulated = fs::last_write_time(TakePaths{take()}.frame(1002));
    fs::last_write_time(old, simulated - std::chrono::seconds(1));
    fs::remove(pictures / "p.1003.png");
    ASSERT_EQ(render("--frames 1001-1003 --skip-existing").exitCode, 0);
    EXPECT_EQ(fs::last_write_time(kept), drawn);
    EXPECT_NE(readFileBytes(old), "old");
    EXPECT_TRUE(fs::exists(pictures / "p.1003.png"));

    // Pictures of one camera and size stayed where those of another were asked for.
    for (const std::string other : {"--camera pan", "--look speed", "--burnin"}) {
        ASSERT_EQ(render("--frames 1001 --skip-existing " + other).exitCode, 0);
        EXPECT_NE(fs::last_write_time(kept), drawn) << other;
        fs::last_write_time(kept, drawn);
        ASSERT_EQ(render("--frames 1001 --skip-existing " + other).exitCode, 0);
        EXPECT_EQ(fs::last_write_time(kept), drawn) << other;
    }
}

TEST_F(RenderOptions, ACameraIsChosenByNameAndAKeyedOneMoves)
{
    ASSERT_EQ(render("--frames 1001,1008").exitCode, 0);
    const Image first = picture(1001), last = picture(1008);
    ASSERT_EQ(render("--frames 1001,1008 --camera pan").exitCode, 0);
    EXPECT_EQ(difference(picture(1001), first), 0.0) << "the pan begins where the still one stands";
    EXPECT_GT(difference(picture(1008), last), 0.01);
    const CommandResult wrong = render("--camera pam");
    EXPECT_EQ(wrong.exitCode, 64);
    EXPECT_NE(wrong.output.find("still, pan"), std::string::npos) << wrong.output;
}

TEST_F(RenderOptions, MotionBlurSmearsWhatMovesAndLeavesAloneWhatStands)
{
    ASSERT_EQ(render("--frames 1003").exitCode, 0);
    const Image sharp = picture(1003);
    ASSERT_EQ(render("--frames 1003 --motion-blur 8").exitCode, 0);
    const Image blurred = picture(1003);
    double standing = 0.0, moving = 0.0;
    for (int y = 0; y < sharp.height; ++y)
        for (int x = 0; x < sharp.width; ++x) {
            // The box flies at a height of 2.5 to 3.5: above row 36 of 90. The stack's foot and the
            // ground in front of it are below row 60, where only the flying shadow may fall.
            double& sum = y < 36 ? moving : standing;
            if (y >= 36 && y < 60) continue;
            sum += (sharp.at(x, y) - blurred.at(x, y)).cwiseAbs().maxCoeff();
        }
    EXPECT_GT(moving, 10.0);
    // Below, the ground is a little darker or lighter as the sky above it is covered.
    EXPECT_LT(standing, 0.25 * moving);
}

TEST_F(RenderOptions, EveryLookDrawsItsOwnPictureAndUnknownOnesNameTheNearest)
{
    std::vector<Image> seen;
    for (const char* look :
         {"shaded", "wireframe", "speed", "sleep", "id", "levels", "overlap", "contacts"}) {
        const CommandResult drawn = render(std::string("--frames 1006 --look ") + look);
        ASSERT_EQ(drawn.exitCode, 0) << drawn.output;
        for (const Image& other : seen) {
            EXPECT_GT(difference(picture(1006), other), 1e-4) << look;
        }
        seen.push_back(picture(1006));
    }
    const CommandResult wrong = render("--look level");
    EXPECT_EQ(wrong.exitCode, 64);
    EXPECT_NE(wrong.output.find("levels"), std::string::npos) << wrong.output;
}

TEST_F(RenderOptions, SpeedAndSleepColourTheBoxThatFliesUnlikeTheStack)
{
    // In its fourth frame the box is straight above the stack, its lower half below the legend.
    // The middle of the low box is 1 below that of the picture, that of the box asleep 2.5 to the
    // left of that, and a unit is 15.9 rows.
    constexpr int kFlying = 45 - 17, kStanding = 45 + 16, kAsleep = 80 - 40;
    const auto warmth = [&](int row, int column = 80) {
        const Color color = picture(1004).at(column, row);
        return color.x() - color.z();
    };
    ASSERT_EQ(render("--frames 1004 --look speed").exitCode, 0);
    const Color slow = scaleColor(0.0), fast = scaleColor(1.0);
    ASSERT_GT(fast.x() - fast.z(), slow.x() - slow.z());
    EXPECT_GT(warmth(kFlying), warmth(kStanding) + 0.2f);
    ASSERT_EQ(render("--frames 1004 --look sleep").exitCode, 0);
    EXPECT_GT(warmth(kFlying), 0.1f) << "what moves is orange";
    EXPECT_LT(warmth(kStanding, kAsleep), -0.1f) << "what stands is blue";
}

TEST_F(RenderOptions, IdAndLevelsTellBodiesApartByTheirColour)
{
    // Places in the picture: as for speed and sleep. What light does to a colour leaves its mix
    // alone.
    const auto mixOf = [&](int row) {
        const Color color = picture(1004).at(80, row);
        return Color(color / color.sum());
    };
    struct Mixes {
        Color flying, upper, lower;
    };
    const auto drawn = [&](const std::string& look) {
        EXPECT_EQ(render("--frames 1004 --look " + look).exitCode, 0);
        return Mixes{mixOf(45 - 17), mixOf(45 + 2), mixOf(45 + 16)};
    };
    const auto areUnlike = [](const Color& a, const Color& b) { return (a - b).norm() > 0.06f; };
    const Mixes ids = drawn("id");
    EXPECT_TRUE(areUnlike(ids.flying, ids.upper));
    EXPECT_TRUE(areUnlike(ids.flying, ids.lower));
    EXPECT_TRUE(areUnlike(ids.upper, ids.lower));

    const Mixes levels = drawn("levels");
    EXPECT_TRUE(areUnlike(levels.upper, levels.lower));
    EXPECT_GT(levels.flying.y(), levels.flying.x()) << "what rests on nothing is green";
}

TEST_F(RenderOptions, ACameraThatMovesBlursWhatStands)
{
    // The stack is in the middle for both cameras, which see nearly the same, and what flies is not
    // there yet, though its shadow is.
    const auto blurOfStack = [&](const std::string& camera) {
        EXPECT_EQ(render("--frames 1002 --camera " + camera).exitCode, 0);
        const Image sharp = picture(1002);
        EXPECT_EQ(render("--frames 1002 --motion-blur 4 --camera " + camera).exitCode, 0);
        const Image blurred = picture(1002);
        float sum = 0.0f;
        for (int y = 40; y < 75; ++y)
            for (int x = 60; x < 100; ++x) sum += (sharp.at(x, y) - blurred.at(x, y)).norm();
        return sum;
    };
    EXPECT_GT(blurOfStack("pan"), 3.0f * blurOfStack("still"));
}

TEST_F(RenderOptions, ACameraOfAFileThatHangsUpsideDownTurnsThePicture)
{
    SceneDescription scene = test::sceneOf({});
    SceneCamera camera;
    camera.eye = {0, 2, 9};
    camera.target = {0, 1.5, 0};
    camera.up = {0, -1, 0};
    scene.cameras = {camera};
    const auto writer = makeFrameWriter(pictures / "hung.glb");
    writer->begin(scene, 1001, 1);
    writer->write(SceneFrame{});
    writer->finish();
    std::ofstream(pictures / "hung.toml")
        << kShotText + "[[camera]]\nname = \"hung\"\nfile = \"hung.glb\"\n";
    ASSERT_EQ(scree("sim " + quoted(pictures / "hung.toml") + " -q --frames 1001 -o " +
                    quoted(pictures / "hung"))
                  .exitCode,
              0);
    const auto draw = [&](const std::string& name) {
        const std::string file = name + ".png";
        EXPECT_EQ(scree("render " + quoted(pictures / "hung") + " -q --frames 1001 --camera " +
                        name + " -o " + quoted(pictures / file))
                      .exitCode,
                  0);
        return readPng(pictures / file).image;
    };
    const Image still = draw("still"), hung = draw("hung");
    double sum = 0.0, straight = 0.0;
    for (int y = 0; y < still.height; ++y)
        for (int x = 0; x < still.width; ++x) {
            const Color seen = hung.at(x, y);
            sum += (seen - still.at(still.width - 1 - x, still.height - 1 - y)).norm();
            straight += (seen - still.at(x, y)).norm();
        }
    // Samples of a pixel do not lie as they did: edges differ a little.
    EXPECT_LT(sum, 0.1 * straight);
}

TEST_F(RenderOptions, LevelsOfAStackDifferAndAContactCarriesTheBoxAboveIt)
{
    const TakeReader reader(take());
    EXPECT_TRUE(reader.info().hasContacts);
    EXPECT_FALSE(reader.readLastStep(1001)) << "no step led to the first frame";
    const std::optional<StepSeen> step = reader.readLastStep(1006);
    ASSERT_TRUE(step);
    EXPECT_EQ(step->level, (std::vector<std::int32_t>{0, 1, 2, 0, 0}));
    double onLow = 0.0;
    for (const ContactSeen& contact : step->contacts)
        if (contact.a == 1 && contact.b == 2) onLow -= contact.impulse.y() / step->dt;
    const double weight = 650.0 * 0.343 * 9.81;
    EXPECT_NEAR(onLow, weight, 0.02 * weight);
}

TEST_F(RenderOptions, ATakeWithoutContactsSaysHowToGetThem)
{
    const fs::path bare = pictures / "bare";
    ASSERT_EQ(scree("sim " + quoted(take().parent_path() / "looks.toml") +
                    " -q --frames 1001-1002 --set output.contacts=false -o " + quoted(bare))
                  .exitCode,
              0);
    const CommandResult wrong =
        scree("render " + quoted(bare) + " --look contacts -o " + quoted(pictures / "b.####.png"));
    EXPECT_EQ(wrong.exitCode, 66);
    EXPECT_NE(wrong.output.find("output.contacts=true"), std::string::npos) << wrong.output;
    // Storing contacts has not changed the simulation.
    const auto without = TakeReader(bare).stats(), with = TakeReader(take()).stats();
    ASSERT_EQ(without.size(), 2U);
    for (std::size_t i = 0; i < without.size(); ++i)
        EXPECT_EQ(without[i].stateHash, with[i].stateHash);
}

TEST_F(RenderOptions, AFilmSaysItsColoursAndShowsThoseOfThePictures)
{
    SCREE_REQUIRE_READER(runCommand("command -v ffprobe && command -v ffmpeg").exitCode == 0,
                         "ffprobe: apt-get install ffmpeg");
    ASSERT_EQ(render("--frames 1001-1004 --size 320x180").exitCode, 0);
    const std::string film = quoted(pictures / "film.mp4");
    const CommandResult made =
        scree("movie " + quoted(pictures / "p.####.png") + " -o " + film + " --fps 24");
    ASSERT_EQ(made.exitCode, 0) << made.output;
    const CommandResult tags = runCommand(
        "ffprobe -v error -select_streams v:0 -of default=noprint_wrappers=1 -show_entries "
        "stream=codec_name,pix_fmt,color_range,color_space,color_transfer,color_primaries,"
        "avg_frame_rate,nb_frames " +
        film);
    for (const char* tag :
         {"codec_name=h264", "pix_fmt=yuv420p", "color_range=tv", "color_space=bt709",
          "color_transfer=bt709", "color_primaries=bt709", "avg_frame_rate=24/1", "nb_frames=4"})
        EXPECT_NE(tags.output.find(tag), std::string::npos) << tag << "\n" << tags.output;

    // A player that believes the tags sees the colours again: measured, the means of a picture come
    // back within 0.0012. BT.601 read as BT.709 shifts them by 0.016, full range read as
    // television's by 0.1.
    const CommandResult decoded =
        runCommand("ffmpeg -nostdin -v error -y -i " + film +
                   " -frames:v 1 -vf scale=in_color_matrix=bt709:in_range=tv:"
                   "flags=bicubic+accurate_rnd+full_chroma_int,format=rgb24 " +
                   quoted(pictures / "decoded.png"));
    ASSERT_EQ(decoded.exitCode, 0) << decoded.output;
    const Color shift = meanOf(readPng(pictures / "decoded.png").image) - meanOf(picture(1001));
    EXPECT_LT(shift.cwiseAbs().maxCoeff(), 0.004F) << shift.transpose();
}

// By name x.10.png comes before x.8.png.
TEST_F(RenderOptions, AFilmOfEverySecondPictureIsInTheOrderOfTheirNumbers)
{
    SCREE_REQUIRE_READER(runCommand("command -v ffmpeg").exitCode == 0,
                         "ffmpeg: apt-get install ffmpeg");
    float grey = 0.1F;
    for (const char* name : {"x.8.png", "x.10.png", "x.12.png"}) {
        writePng(pictures / name, Image(64, 64, Color::Constant(grey)));
        grey += 0.3F;
    }
    const std::string film = quoted(pictures / "x.mp4");
    ASSERT_EQ(scree("movie " + quoted(pictures / "x.#.png") + " -o " + film).exitCode, 0);
    ASSERT_EQ(
        runCommand("ffmpeg -nostdin -v error -y -i " + film + " " + quoted(pictures / "y.%d.png"))
            .exitCode,
        0);
    float before = 0.0F;
    for (const char* name : {"y.1.png", "y.2.png", "y.3.png"}) {
        const float mean = meanOf(readPng(pictures / name).image).x();
        EXPECT_GT(mean, before) << name;
        before = mean;
    }
}

TEST_F(RenderOptions, AFilmShowsThePicturesThatItsPatternNumbersAndNoOthers)
{
    SCREE_REQUIRE_READER(runCommand("command -v ffmpeg").exitCode == 0,
                         "ffmpeg: apt-get install ffmpeg");
    // A dash before a number is no sign of it, and a sheet has none.
    for (const char* name : {"x-01.png", "x-03.png", "x-05.png", "x-99sheet.png", "x-ab.png"})
        writePng(pictures / name, Image(64, 64, Color::Constant(0.5F)));
    const std::string film = quoted(pictures / "x.mp4");
    const CommandResult made = scree("movie " + quoted(pictures / "x-##.png") + " -o " + film);
    ASSERT_EQ(made.exitCode, 0) << made.output;
    const CommandResult count =
        runCommand("ffmpeg -nostdin -v error -y -i " + film + " " + quoted(pictures / "y%d.jpg"));
    ASSERT_EQ(count.exitCode, 0) << count.output;
    EXPECT_TRUE(fs::exists(pictures / "y3.jpg"));
    EXPECT_FALSE(fs::exists(pictures / "y4.jpg"));
}

TEST_F(RenderOptions, ASlateTakesNoPicturesPlace)
{
    const std::string asked = "render " + quoted(take()) + " --size 64x36 --slate --frames ";
    const CommandResult refused = scree(asked + "1003-1004");
    EXPECT_EQ(refused.exitCode, 64);
    EXPECT_NE(refused.output.find("the picture of frame 1002"), std::string::npos)
        << refused.output;
    // Before every second picture it stands where one of these would.
    ASSERT_EQ(render("--frames 1001-1007x2 --slate").exitCode, 0);
    EXPECT_EQ(files().front(), "p.0999.png");
    EXPECT_EQ(files().size(), 5u);
}

// "152 bodies" stood under a picture of three coins: the others had yet to be poured.
TEST(TakePainter, CountsOnlyWhoIsThere)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "s.toml") << shotTextOf(
        {.frames = "1001-1004"},
        "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 2\nframes = "
        "\"1001-1003\"\nlayout = { position = [0, 9, 0], grid = { count = [2, 1, 1], spacing = [3, "
        "0, 0] } }\n");
    const CommandResult made =
        runCommand(quoted(SCREE_PROGRAM) + " sim -q " + quoted(folder / "s.toml") + " -o " +
                   quoted(folder / "take"));
    ASSERT_EQ(made.exitCode, 0) << made.output;
    const TakeReader take(folder / "take");
    const TakePainter painter(take, "", {160, 90});
    EXPECT_EQ(painter.bodyCountAt(1001), 2u) << "the ground and one block";
    EXPECT_EQ(painter.bodyCountAt(1004), 3u);
}

// Pins that were bowled off a lane fell on, and the lane was a few pixels wide.
TEST(TakePainter, WhatFallsOffTheSetDoesNotWidenTheView)
{
    const auto distance = [](const std::string& frames) {
        const TemporaryFolder folder;
        std::ofstream(folder / "s.toml")
            << "scree = 1\n[shot]\nname = \"s\"\nframes = \"" + frames +
                   "\"\n[material.wood]\ndensity = 600\n[shape.block]\nbox = { size = [1, 1, 1] "
                   "}\n[[body]]\nname = \"table\"\nshape = \"block\"\nmaterial = \"wood\"\nmotion "
                   "= \"static\"\n[[body]]\nname = \"block\"\nshape = \"block\"\nmaterial = "
                   "\"wood\"\nposition = [1.1, 1, 0]\n";
        const CommandResult made =
            runCommand(quoted(SCREE_PROGRAM) + " sim -q " + quoted(folder / "s.toml") + " -o " +
                       quoted(folder / "take"));
        EXPECT_EQ(made.exitCode, 0) << made.output;
        const TakeReader take(folder / "take");
        const SceneCamera view =
            viewOfAction(take, take.describe(TakeReader::PlaneSize::any), 16.0 / 9.0);
        return (view.eye - view.target).norm();
    };
    // It falls past the table in half a second, and in two as far as a house is high.
    EXPECT_LT(distance("1001-1049"), 1.2 * distance("1001-1015"));
}

// A view of all that happens grows with the take: half of a film was seen from nearer by.
TEST_F(RenderOptions, SkipExistingDrawsAgainWhatTheWholeTakeShowsOtherwise)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "s.toml") << test::shotTextOf(
        {.frames = "1001-1012"},
        test::bodyText("block", "position = [0, 0.5, 0]\nvelocity = [9, 0, 0]"));
    const std::string made = " -q " + quoted(folder / "s.toml") + " -o " + quoted(folder / "t");
    const std::string drawn = "render -q " + quoted(folder / "t") + " --size 64x36 -o " +
                              quoted(pictures / "p.####.png") + " --skip-existing";
    for (const std::string look : {"shaded", "speed"}) {
        fs::remove_all(folder / "t");
        ASSERT_EQ(scree("sim" + made + " --frames 1001-1003").exitCode, 0);
        scree(drawn + " --look " + look);
        const Image before = picture(1001);
        ASSERT_EQ(scree("sim" + made + " --resume").exitCode, 0);
        ASSERT_EQ(scree(drawn + " --look " + look).exitCode, 0);
        EXPECT_GT(difference(before, picture(1001)), 0.0) << look;
    }
}

}  // namespace
}  // namespace scree::test
