// What the program says and leaves when it is used in haste: stopped, pointed at the wrong thing,
// told to write over its own files.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/file_bytes.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"
#include "tests/tools/program_fixture.h"
#include "tools/picture_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::Program;
using test::runScree;
using test::says;
using test::TemporaryFolder;

class MishapsTest : public test::ProgramFixture {
protected:
    /// A shot of one block above a ground, as a file.
    std::string shot(const std::string& name, const std::string& frames = "1001-1005",
                     const std::string& more = "")
    {
        return shotFile(name + ".toml",
                        test::shotTextOf({.name = name, .frames = frames},
                                         test::bodyText("block", "position = [0, 0.6, 0]") + more));
    }

    std::string take(const std::string& name, const std::string& frames = "1001-1005",
                     const std::string& more = "")
    {
        const Outcome outcome = runScree({"sim", shot(name, frames, more), "-o", file(name), "-q"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return file(name);
    }

    nlohmann::json info(const std::string& path)
    {
        return nlohmann::json::parse(runScree({"info", path, "--json"}).out);
    }
};

// They ended with 143 and said nothing.
TEST_F(MishapsTest, WhatReadsOrJudgesStopsWith75)
{
    const std::string a = take("a", "1001-9000");
    const std::vector<std::vector<std::string>> commands = {
        {"diff", a, a}, {"info", a}, {"verify", "E7", "-o", file("out.html")}};
    for (const std::vector<std::string>& words : commands) {
        const Outcome stopped = signalled(words, SIGTERM, 150);
        EXPECT_EQ(stopped.code, 75) << words[0] << ": " << stopped.err;
        EXPECT_TRUE(says(stopped, "stopped")) << stopped.err;
    }
    EXPECT_FALSE(fs::exists(file("out.html")));
}

// nohup and its like ignore it for the program, which then listened to it all the same.
TEST_F(MishapsTest, AHangUpThatIsIgnoredStaysIgnored)
{
    Program program({"sim", shot("long", "1001-9000"), "-o", file("long"), "-q"},
                    [] { ::signal(SIGHUP, SIG_IGN); });
    ASSERT_TRUE(waitForFrame("long", 1001));
    program.signal(SIGHUP);
    test::wait(300);
    const int framesSoon = static_cast<int>(listFrames({file("long")}).size());
    test::wait(300);
    EXPECT_GT(static_cast<int>(listFrames({file("long")}).size()), framesSoon);
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().code, 75);
}

// Opening the pipe waited for a writer, and no signal was heard.
TEST_F(MishapsTest, APipeInPlaceOfAFileIsRefusedAtOnce)
{
    ::mkfifo(file("pipe.toml").c_str(), 0600);
    ::mkfifo(file("pipe.obj").c_str(), 0600);
    const Outcome asShot = runScree({"check", file("pipe.toml")});
    EXPECT_EQ(asShot.code, 66);
    EXPECT_TRUE(says(asShot, "pipe.toml' cannot be reached: it is a pipe")) << asShot.err;
    const std::string mesh = "[shape.bone]\nfile = \"pipe.obj\"\n";
    const Outcome asMesh =
        runScree({"check", shot("m", "1001-1002", mesh + test::bodyText("b", "", "bone"))});
    EXPECT_EQ(asMesh.code, 66);
    EXPECT_TRUE(says(asMesh, ".toml:") && says(asMesh, "it is a pipe")) << asMesh.err;
    fs::create_directory(file("take"));
    ::mkfifo(file("take/take.json").c_str(), 0600);
    EXPECT_EQ(runScree({"info", file("take")}).code, 66);
}

TEST_F(MishapsTest, AFolderWithoutAShotIsAMissingInput)
{
    fs::create_directory(file("empty"));
    const Outcome outcome = runScree({"check", file("empty")});
    EXPECT_EQ(outcome.code, 66);
    EXPECT_TRUE(says(outcome, "is a folder without a shot.toml")) << outcome.err;
}

// A take of empty files was called finished.
TEST_F(MishapsTest, InfoCallsATakeWithDamagedFramesUnfinishedAndNamesThem)
{
    const std::string whole = take("t");
    EXPECT_TRUE(info(whole).at("finished"));
    EXPECT_EQ(info(whole).at("damaged_frames"), "");
    fs::resize_file(TakePaths{whole}.frame(1002), 0);
    fs::resize_file(TakePaths{whole}.frame(1004), 0);
    EXPECT_FALSE(info(whole).at("finished"));
    EXPECT_EQ(info(whole).at("damaged_frames"), "1002-1004x2");
    const Outcome text = runScree({"info", whole});
    EXPECT_NE(text.out.find("unfinished"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("frame.001002.scree"), std::string::npos) << text.out;
}

// Whoever was keyed and then released was awake, but not among the movable.
TEST_F(MishapsTest, ABodyThatIsReleasedCountsAmongTheMovable)
{
    const std::string thrown =
        "[[body]]\nname = \"thrown\"\nshape = \"block\"\nmaterial = \"wood\"\nmotion = \"keyed\"\n"
        "keys = [{ frame = 1001, position = [3, 2, 0] }, { frame = 1003, position = [3, 3, 0] }]\n";
    const std::string path = take("t", "1001-1005", thrown + "release = 1003\n");
    EXPECT_EQ(info(path).at("movable_bodies"), 2);
    EXPECT_NE(runScree({"check", file("t.toml")}).out.find("2 of them movable"), std::string::npos);
    EXPECT_EQ(info(take("keyed", "1001-1005", thrown)).at("movable_bodies"), 1);
}

TEST_F(MishapsTest, InfoSaysWhoIsFastestInTheLastFrame)
{
    const std::string two = test::bodyText("slow", "position = [2, 20, 0]") +
                            test::bodyText("fast", "position = [4, 20, 0]\nvelocity = [9, 0, 0]");
    const std::string driven =
        test::bodyText("lift",
                       "motion = \"keyed\"\nkeys = [{ frame = 1001, position = [9, 9, 0] }, "
                       "{ frame = 1101, position = [9, 999, 0] }]");
    const std::string path = take("t", "1001-1005", two + driven);
    const nlohmann::json fastest = info(path).at("last_fastest");
    ASSERT_EQ(fastest.size(), 3u);
    EXPECT_EQ(fastest[0].at("body"), "fast");
    EXPECT_EQ(fastest[1].at("body"), "slow");
    EXPECT_NEAR(fastest[0].at("speed_m_per_s"), std::hypot(9.0, 9.81 * 4.0 / 24.0), 1e-3);
    EXPECT_NE(
        runScree({"info", path}).out.find("fastest    fast at 9.15 m/s, 0 degrees/s; slow at 1.6"),
        std::string::npos);

    // Who only spins keeps a heap awake too, and was not named.
    const std::string spinning =
        test::bodyText("top", "position = [8, 20, 0]\nspin = [0, 2000, 0]") + two;
    const nlohmann::json spinner = info(take("spin", "1001-1002", spinning)).at("last_fastest")[0];
    EXPECT_EQ(spinner.at("body"), "top");
    EXPECT_NEAR(spinner.at("spin_degrees_per_s"), 2000.0, 1.0);

    const std::string still = take("still", "1001-1060", driven);
    EXPECT_TRUE(info(still).at("last_fastest").empty());
    EXPECT_EQ(runScree({"info", still}).out.find("fastest"), std::string::npos);
}

// A take began beside somebody's pictures, and when it was replaced they went with it.
TEST_F(MishapsTest, ATakeDoesNotBeginWherePicturesLieThatAreNotItsOwn)
{
    fs::create_directories(folder / "work/images");
    std::ofstream(folder / "work/images/mine.png") << "mine";
    std::ofstream(folder / "work/notes.txt") << "mine too";
    const Outcome refused = runScree({"sim", shot("t"), "-o", file("work")});
    EXPECT_EQ(refused.code, 73);
    EXPECT_TRUE(says(refused, "images\" is not made from a take: move it away")) << refused.err;
    EXPECT_TRUE(fs::exists(folder / "work/images/mine.png"));
    fs::remove(folder / "work/images/mine.png");
    EXPECT_EQ(runScree({"sim", shot("t"), "-o", file("work"), "-q"}).code, 0);
    EXPECT_EQ(runScree({"sim", shot("t"), "-o", file("work"), "-q", "--overwrite"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "work/notes.txt"));
}

// The first frame beyond the limit was told, and not that later ones were three times as deep.
TEST_F(MishapsTest, ARunEndsWithTheWorstOverlapBeyondTheWarning)
{
    const std::string two = test::bodyText("low", "position = [3, 0.5, 0]") +
                            test::bodyText("high", "position = [3.2, 1.35, 0.1]");
    const Outcome outcome = runScree({"sim", shot("t", "1001-1006", two), "-o", file("t"), "--set",
                                      "start.overlap=\"warn\"", "--set", "solver.push_out=false",
                                      "--set", "solver.penetration.warn=0.02"});
    EXPECT_EQ(outcome.code, 79) << outcome.err;
    const Outcome mild =
        runScree({"sim", shot("m", "1001-1006", two), "-o", file("m"), "--set",
                  "start.overlap=\"warn\"", "--set", "solver.push_out=false", "--set",
                  "solver.penetration.warn=0.02", "--set", "solver.penetration.fail=0.9"});
    EXPECT_EQ(mild.code, 0) << mild.err;
    EXPECT_TRUE(says(mild, " frames overlap by more than penetration.warn = 2 %; worst: "))
        << mild.err;
}

TEST_F(MishapsTest, NothingIsWrittenOverTheFilesOfATake)
{
    const std::string path = take("t");
    const fs::path info = TakePaths{path}.info();
    const std::string before = readFileBytes(info);
    const std::vector<std::vector<std::string>> commands = {
        {"settle", file("t.toml"), "-o", info},
        {"settle", file("t.toml"), "-o", TakePaths{path}.shape("block")},
        {"stats", path, "--pictures", "0", "-o", TakePaths{path}.frames() / "page"},
        {"verify", "E6", "-o", TakePaths{path}.shapes() / "page.html"}};
    for (const std::vector<std::string>& words : commands) {
        const Outcome refused = runScree(words);
        EXPECT_EQ(refused.code, 73) << words[0] << ": " << refused.err;
        EXPECT_TRUE(says(refused, "belongs to the take")) << refused.err;
    }
    EXPECT_EQ(readFileBytes(info), before);
    EXPECT_EQ(runScree({"stats", path, "--pictures", "0"}).code, 0);
    EXPECT_EQ(runScree({"settle", file("t.toml"), "-o", path + "/pose.json"}).code, 0);
}

// They were hidden files that stayed for ever: a farm kills many a run.
TEST_F(MishapsTest, TheNextRunClearsAwayWhatKilledOnesLeft)
{
    const std::string path = take("t");
    ASSERT_EQ(runScree({"render", path, "-o", file("out/p.####.png"), "--size", "64x64"}).code, 0);
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ::waitpid(gone, nullptr, 0);
    const std::vector<std::pair<std::string, std::vector<std::string>>> runs = {
        {"p.1001.png", {"render", path, "--size", "64x64"}},
        {"m.1001.obj", {"export", path}},
        {"c.abc", {"export", path}},
        {"h.1001.pov", {"export", path}},
        {"f.mp4", {"movie", file("out/p.####.png")}},
        {"s.png", {"sheet", path}}};
    for (const auto& [name, command] : runs) {
        const fs::path left = file("out") + "/." + name + "." + std::to_string(gone) + "-0.tmp";
        writeFileBytes(left, "half");
        fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(2));
        std::vector<std::string> words = command;
        const bool isSequence = name.find(".1001.") != std::string::npos;
        words.insert(
            words.end(),
            {"-o",
             file("out/") + (isSequence ? name.substr(0, 1) + ".####" + name.substr(6) : name)});
        const Outcome outcome = runScree(words);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_FALSE(fs::exists(left)) << left;
        EXPECT_TRUE(says(outcome, "removed 1 file that killed runs had left half written"))
            << outcome.err;
    }
}

TEST_F(MishapsTest, APageIsNotGivenTheEndingOfSomethingElse)
{
    const std::string path = take("t");
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"stats", path, "-o", file("page.txt")}, {"verify", "E6", "-o", file("page.txt")}}) {
        const Outcome refused = runScree(words);
        EXPECT_EQ(refused.code, 64);
        EXPECT_TRUE(says(refused, ".html")) << refused.err;
    }
    EXPECT_FALSE(fs::exists(file("page.txt")));
    EXPECT_EQ(runScree({"stats", path, "--pictures", "0", "-o", file("page.HTM")}).code, 0);
}

// It made a file "=out.abc".
TEST_F(MishapsTest, AShortOptionWithAnEqualsSignIsRefused)
{
    const std::string path = take("t");
    for (const std::string value : {"", "out.abc"}) {
        const Outcome refused = runScree({"export", path, "-o=" + value});
        EXPECT_EQ(refused.code, 64);
        EXPECT_TRUE(says(refused, "comes after a space")) << refused.err;
    }
}

TEST_F(MishapsTest, AnEmitterInsideWhatIsStaticIsWarnedOf)
{
    const auto emitter = [](const std::string& heights) {
        return "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 3\n"
               "frames = \"1001-1004\"\nbox = { min = [8, " +
               heights + ", 8] }\n";
    };
    const Outcome under =
        runScree({"check", shot("under", "1001-1005", emitter("-9, 8], max = [9, -5"))});
    EXPECT_EQ(under.code, 0);
    EXPECT_NE(under.out.find("3 of 3 emitted bodies can never come"), std::string::npos)
        << under.out;
    EXPECT_NE(under.out.find("'ground'"), std::string::npos) << under.out;
    const Outcome above =
        runScree({"check", shot("above", "1001-1005", emitter("5, 8], max = [9, 9"))});
    EXPECT_EQ(above.out.find("never come"), std::string::npos) << above.out;
}

/// Of a building in a thousand shards the check was seven thousand lines long.
TEST_F(MishapsTest, OfManyShapesCheckTellsWhichToLookAtFirst)
{
    std::string many;
    for (int i = 1; i <= 24; ++i) {
        const std::string number = std::to_string(i);
        many += "[shape.s" + number + "]\nbox = { size = [1, 1, 0." +
                std::to_string(100 + (i == 7 ? 0 : i)) + "] }\n" +
                test::bodyText("b" + number, "position = [0, 0.6, " + std::to_string(3 * i) + "]",
                               "s" + number);
    }
    const std::string path = shot("many", "1001-1002", many);
    const Outcome together = runScree({"check", path, "--estimate", "0"});
    EXPECT_EQ(together.code, 0) << together.err;
    EXPECT_NE(together.out.find("25 shapes of "), std::string::npos) << together.out;
    EXPECT_NE(together.out.find("thinnest  a wall of 0.1 m: \"s7\""), std::string::npos)
        << together.out;
    EXPECT_EQ(together.out.find("s8: 1 body"), std::string::npos) << together.out;
    const Outcome each = runScree({"check", path, "--estimate", "0", "--shapes"});
    EXPECT_EQ(each.out.find("25 shapes"), std::string::npos) << each.out;
    EXPECT_NE(each.out.find("s8: 1 body"), std::string::npos) << each.out;
}

TEST_F(MishapsTest, WhatNoCacheCanHoldIsNamedAndNothingIsWritten)
{
    // Far away and unmoved, so that no step is broken by it.
    const std::string path =
        take("far", "1001-1002",
             test::bodyText("far", "motion = \"static\"\nposition = [3.5e38, 0, 0]"));
    for (const char* name : {"x.abc", "x.usda", "x.instances.usda", "x.glb", "x.####.ply"}) {
        const Outcome refused = runScree({"export", path, "-o", file(name)});
        EXPECT_EQ(refused.code, 79) << name << ": " << refused.err;
        EXPECT_TRUE(says(refused, "frame 1001: pose or velocity of \"far\"")) << refused.err;
        EXPECT_FALSE(fs::exists(file(name)));
    }
}

// ffmpeg's own error was all there was, and every n-th picture ran backwards.
TEST_F(MishapsTest, PicturesBelowZeroBecomeAFilmInTheirOrder)
{
    for (int frame = -12; frame <= 3; ++frame) {
        char name[32];
        std::snprintf(name, sizeof name, "p.%04d.png", frame);
        writePng(file(name), Image(16, 16));
        if (frame % 5 == -2) fs::copy_file(file(name), file("q" + std::string(name + 1)));
    }
    for (const std::string letter : {"p", "q"}) {
        const Outcome made =
            runScree({"movie", file(letter + ".####.png"), "-o", file(letter + ".mp4")});
        EXPECT_EQ(made.code, 0) << made.err;
        ASSERT_NE(made.err.find(".-007.png"), std::string::npos) << made.err;
        EXPECT_LT(made.err.find(".-012.png"), made.err.find(".-007.png")) << made.err;
        EXPECT_GT(fs::file_size(file(letter + ".mp4")), 500u);
    }
}

TEST_F(MishapsTest, SlipsInTheValuesOfOptionsAreAnsweredWithTheNearestWord)
{
    const std::string camera = "[[camera]]\nname = \"main\"\neye = [3, 3, 3]\ntarget = [0, 0, 0]\n";
    const std::string path = take("t", "1001-1002", camera);
    const std::vector<std::pair<std::vector<std::string>, std::string>> slips = {
        {{"render", path, "--engine", "embre"}, "embree"},
        {{"render", path, "--camera", "mian"}, "main"},
        {{"render", path, "--progress", "tyt"}, "tty"},
        {{"--log-format", "jsn", "info", path}, "json"}};
    for (const auto& [words, meant] : slips) {
        const Outcome refused = runScree(words);
        EXPECT_EQ(refused.code, 64);
        EXPECT_TRUE(says(refused, "did you mean '" + meant + "'?")) << refused.err;
    }
}

// A file that may not grow was told as a disk without space.
TEST_F(MishapsTest, ALimitOnFilesIsNotCalledAFullDisk)
{
    const Outcome full = Program({"sim", shot("t", "1001-1040"), "-o", file("t"), "-q"}, [] {
                             const rlimit limit = {12000, 12000};
                             ::setrlimit(RLIMIT_FSIZE, &limit);
                         }).wait();
    EXPECT_EQ(full.code, 74);
    EXPECT_TRUE(says(full, "stats.jsonl\" failed: File too large")) << full.err;
}

TEST_F(MishapsTest, TheFirstLineOfTheFiguresTellsHowDeepTheStartOverlaps)
{
    const std::string overlapping =
        "[start]\noverlap = \"warn\"\n" + test::bodyText("deep", "position = [3, 0.45, 0]");
    const std::string path = take("t", "1001-1002", overlapping);
    std::ifstream lines(TakePaths{path}.stats());
    std::string first;
    std::getline(lines, first);
    const nlohmann::json overlap = nlohmann::json::parse(first).at("overlap");
    EXPECT_NEAR(overlap.at("worst_ratio"), 0.05, 1e-6);
    EXPECT_NEAR(overlap.at("after_push_out_m"), 0.05, 1e-6);
    EXPECT_EQ(
        overlap.at("bodies")[0].get<std::string>() + overlap.at("bodies")[1].get<std::string>(),
        "grounddeep");
}

TEST_F(MishapsTest, WhatHasComeThroughAWallIsToldWhereverThatIs)
{
    // Two boards crosswise, as nothing but the shot itself puts them.
    const std::string crossed =
        "[start]\noverlap = \"warn\"\n[shape.board]\nbox = { size = [1, 0.01, 0.6] }\n" +
        test::bodyText("upright",
                       "position = [9, 0.5, 0]\nrotation = [0, 0, 90]\nmotion = \"static\"",
                       "board") +
        test::bodyText("loose", "position = [9, 0.2, 0]", "board");
    const Outcome done = runScree({"sim", shot("t", "1001-1050", crossed), "-o", file("t"), "-q"});
    EXPECT_TRUE(says(done, "frame 1002: upright and loose")) << done.err;
    EXPECT_TRUE(says(done, "through a wall")) << done.err;
}

// Of sleepers no contact tells; between two looks at all poses they were said to be apart.
TEST_F(MishapsTest, AnOverlapThatContactsDoNotTellOfIsInTheFiguresOfEveryFrame)
{
    const std::string asleep = "[start]\noverlap = \"warn\"\n" +
                               test::bodyText("a", "position = [4, 2, 0]\nstart = \"asleep\"") +
                               test::bodyText("b", "position = [4.5, 2.1, 0]\nstart = \"asleep\"");
    runScree({"sim", shot("t", "1001-1006", asleep), "-o", file("t"), "-q"});
    std::ifstream lines(TakePaths{file("t")}.stats());
    int frames = 0;
    for (std::string line; std::getline(lines, line); ++frames) {
        const nlohmann::json overlap = nlohmann::json::parse(line).at("overlap");
        EXPECT_NEAR(overlap.at("after_push_out_m"), 0.5, 0.11) << line;
        EXPECT_EQ(overlap.at("bodies")[1], "b") << line;
    }
    EXPECT_EQ(frames, 6);
}

// A farm took them for whole: never 0 with frames missing.
TEST_F(MishapsTest, WhatTellsOfATakeThatLacksFramesExitsWith66)
{
    const std::string path = take("t");
    EXPECT_EQ(runScree({"info", path}).code, 0);
    EXPECT_EQ(runScree({"stats", path, "--pictures", "0"}).code, 0);
    fs::resize_file(TakePaths{path}.frame(1002), 0);
    EXPECT_EQ(runScree({"info", path, "--json"}).code, 66);
    fs::remove(TakePaths{path}.frame(1004));
    const Outcome told = runScree({"info", path});
    EXPECT_EQ(told.code, 66);
    EXPECT_TRUE(says(told, "lacks frames 1002,1004 of the shot")) << told.err;
    const Outcome plotted = runScree({"stats", path, "--pictures", "0"});
    EXPECT_EQ(plotted.code, 66);
    EXPECT_TRUE(says(plotted, "lacks frames 1004 of the shot")) << plotted.err;
    EXPECT_TRUE(fs::exists(TakePaths{path}.statsPage()));
}

}  // namespace
}  // namespace scree
