// The whole program: exit codes, interruption and resume, as a shell or a farm meets them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "io/file_bytes.h"
#include "io/frame_stats.h"
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
using test::TemporaryFolder;

// Many short steps, so that a signal nearly always arrives inside a frame.
const std::string kShotText = test::shotTextOf(
    {.name = "boxes",
     .frames = "1001-1040",
     .shotKeys = "[solver]\nsubsteps = { min = 40, max = 256 }",
     .woodKeys = "friction = 0.4\nrestitution = 0.2\n"},
    test::bodyText("low", "position = [0, 0.55, 0]") +
        test::bodyText("high", "position = [0.3, 1.9, 0.1]\nrotation = [15, 0, 35]"));

class ProgramTest : public test::ProgramFixture {
protected:
    ProgramTest() { shotFile("boxes.toml", kShotText); }

    std::string shot() const { return file("boxes.toml"); }
    std::string take(const std::string& name) const { return file(name); }

    /// The take of a run that nothing disturbed.
    void simulateUnbroken()
    {
        const Outcome outcome = runScree({"sim", shot(), "-o", take("unbroken"), "--threads", "1"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    void expectSameFrames(const std::string& nameA, const std::string& nameB) const
    {
        const TakePaths a{take(nameA)}, b{take(nameB)};
        ASSERT_EQ(listFrames(a), listFrames(b));
        for (const int frame : listFrames(a))
            EXPECT_EQ(readFileBytes(a.frame(frame)), readFileBytes(b.frame(frame)))
                << "frame " << frame;
        const auto statsA = readStats(a.stats()), statsB = readStats(b.stats());
        ASSERT_EQ(statsA.size(), statsB.size());
        for (std::size_t i = 0; i < statsA.size(); ++i)
            EXPECT_EQ(statsA[i].stateHash, statsB[i].stateHash);
    }
};

TEST_F(ProgramTest, KilledRunResumesToTheSameBytes)
{
    simulateUnbroken();
    Program program({"sim", shot(), "-o", take("killed"), "--threads", "1"});
    ASSERT_TRUE(waitForFrame("killed", 1010));
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait().code, -SIGKILL);
    ASSERT_FALSE(fs::exists(TakePaths{take("killed")}.frame(1040))) << "killed too late to tell";

    const Outcome resumed = runScree({"sim", shot(), "-o", take("killed"), "--resume"});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    expectSameFrames("unbroken", "killed");
}

TEST_F(ProgramTest, InterruptedRunExitsWith75AndResumesToTheSameBytes)
{
    simulateUnbroken();
    for (const int number : {SIGINT, SIGTERM}) {
        const std::string name = "stopped" + std::to_string(number);
        Program program({"sim", shot(), "-o", take(name), "--threads", "1"});
        ASSERT_TRUE(waitForFrame(name, 1005));
        program.signal(number);
        const Outcome stopped = program.wait();
        EXPECT_EQ(stopped.code, 75) << stopped.err;
        EXPECT_NE(stopped.err.find("--resume"), std::string::npos) << stopped.err;

        const Outcome resumed = runScree({"sim", shot(), "-o", take(name), "--resume"});
        EXPECT_EQ(resumed.code, 0) << resumed.err;
        expectSameFrames("unbroken", name);
        EXPECT_FALSE(fs::exists(TakePaths{take(name)}.checkpoint()));
    }
}

TEST_F(ProgramTest, SaveRequestIsAnsweredAndChangesNothing)
{
    simulateUnbroken();
    Program program({"sim", shot(), "-o", take("saved")});
    ASSERT_TRUE(waitForFrame("saved", 1005));
    program.signal(SIGUSR1);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("scree: saved in frame"), std::string::npos) << outcome.err;
    expectSameFrames("unbroken", "saved");
}

// A request during the last frame left a checkpoint of a frame that does not exist.
TEST_F(ProgramTest, SaveRequestsUpToTheEndLeaveNoCheckpointInAFinishedTake)
{
    Program program({"sim", shot(), "-o", take("saved"), "--frames", "1001-1040"});
    ASSERT_TRUE(waitForFrame("saved", 1001));
    for (int i = 0; i < 20000 && !fs::exists(TakePaths{take("saved")}.frame(1040)); ++i) {
        program.signal(SIGUSR1);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("frame 1041"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(TakePaths{take("saved")}.checkpoint()));
}

TEST_F(ProgramTest, RunInTwoPartsEqualsTheUnbrokenOne)
{
    simulateUnbroken();
    const std::string output = take("parts");
    EXPECT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1001-1015"}).code, 0);
    EXPECT_EQ(listFrames({output}).back(), 1015);
    EXPECT_EQ(runScree({"sim", shot(), "-o", output, "--resume", "--threads", "2"}).code, 0);
    expectSameFrames("unbroken", "parts");
}

TEST_F(ProgramTest, DamagedFramesAreReportedAndSimulatedAgain)
{
    simulateUnbroken();
    fs::copy(take("unbroken"), take("damaged"), fs::copy_options::recursive);
    const TakePaths paths{take("damaged")};
    fs::resize_file(paths.frame(1040), 100);
    std::string bytes = readFileBytes(paths.frame(1020));
    bytes[700] ^= 1;
    std::ofstream(paths.frame(1020), std::ios::binary) << bytes;

    const Outcome outcome = runScree({"sim", shot(), "-o", take("damaged"), "--resume"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("frame.001020.scree"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("frame.001040.scree"), std::string::npos) << outcome.err;
    expectSameFrames("unbroken", "damaged");
}

// A limit on the size of files stands in for a full disk: the system refuses in the same call.
TEST_F(ProgramTest, FullDiskExitsWith74AndLosesNoFrame)
{
    simulateUnbroken();
    Program program({"sim", shot(), "-o", take("full")}, [] {
        const rlimit limit = {12000, 12000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    });
    const Outcome full = program.wait();
    EXPECT_EQ(full.code, 74) << full.err;
    EXPECT_NE(full.err.find("stats.jsonl"), std::string::npos) << full.err;
    EXPECT_GT(listFrames({take("full")}).size(), 3u);

    EXPECT_EQ(runScree({"sim", shot(), "-o", take("full"), "--resume"}).code, 0);
    expectSameFrames("unbroken", "full");
}

/// Names of all files in a folder, hidden ones too.
std::vector<std::string> namesIn(const fs::path& path)
{
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

const std::vector<std::string> kExports = {
    "boxes.abc",      "boxes.usda",     "boxes.instances.usda", "boxes.glb",
    "boxes.####.obj", "boxes.####.ply", "boxes.####.pov"};

TEST_F(ProgramTest, ADiskThatFillsDuringAnExportExitsWith74AndLeavesNoHalfFile)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1001-1003"}).code, 0);
    for (const std::string& name : kExports) {
        const fs::path output = fs::path(take("out")) / name;
        Program program({"export", take("t"), "--frames", "1001-1003", "-o", output}, [] {
            const rlimit limit = {200, 200};  // fewer bytes than any of the files has
            ::setrlimit(RLIMIT_FSIZE, &limit);
        });
        const Outcome full = program.wait();
        EXPECT_EQ(full.code, 74) << name << ": " << full.err;
        EXPECT_TRUE(full.err.find("Error: writing ") != std::string::npos) << full.err;
        EXPECT_EQ(namesIn(take("out")), std::vector<std::string>()) << name;
    }
}

TEST_F(ProgramTest, AnExportThatFailsLeavesTheOneBeforeItAlone)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1001-1003"}).code, 0);
    for (const std::string name : {"boxes.abc", "boxes.usda", "boxes.glb"}) {
        ASSERT_EQ(
            runScree({"export", take("t"), "--frames", "1001-1003", "-o", folder / name}).code, 0);
    }
    // A take cut short: the exports of before stay, and nothing is left of the new ones.
    fs::resize_file(TakePaths{take("t")}.frame(1003), 1000);
    const std::vector<std::string> before = namesIn(folder.path());
    for (const std::string name : {"boxes.abc", "boxes.usda", "boxes.glb"}) {
        const std::string bytes = readFileBytes(folder / name);
        const Outcome damaged = runScree({"export", take("t"), "-o", folder / name});
        EXPECT_EQ(damaged.code, 74) << damaged.err;
        EXPECT_NE(damaged.err.find("frame.001003.scree"), std::string::npos) << damaged.err;
        EXPECT_EQ(readFileBytes(folder / name), bytes) << name;
    }
    EXPECT_EQ(namesIn(folder.path()), before);
}

TEST_F(ProgramTest, TakesAreNotWrittenOverUnasked)
{
    const std::string output = take("twice");
    ASSERT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1003"}).code, 0);
    const Outcome unfinished = runScree({"sim", shot(), "-o", output});
    EXPECT_EQ(unfinished.code, 73);
    EXPECT_NE(unfinished.err.find("--resume"), std::string::npos) << unfinished.err;
    EXPECT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1002", "--overwrite"}).code, 0);
    EXPECT_EQ(listFrames({output}).back(), 1002);
}

TEST_F(ProgramTest, ResumingAnotherShotExitsWith65)
{
    const std::string output = take("other");
    ASSERT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1002"}).code, 0);
    const Outcome outcome =
        runScree({"sim", shot(), "-o", output, "--resume", "--set", "material.wood.friction=0.9"});
    EXPECT_EQ(outcome.code, 65);
    EXPECT_NE(outcome.err.find("another shot: this one has material.wood.friction = 0.9 (the take "
                               "has 0.4)"),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("--from"), std::string::npos) << outcome.err;
}

TEST_F(ProgramTest, ExitCodesTellWhatWentWrong)
{
    std::ofstream(folder / "bad.toml") << "scree = 1\n[shot]\nnaem = \"x\"\n";
    EXPECT_EQ(runScree({}).code, 64);
    const auto refusal = [](const std::vector<std::string>& words) {
        const Outcome outcome = runScree(words);
        EXPECT_EQ(outcome.code, 64);
        return outcome.err;
    };
    const std::string command = refusal({"simm"}), option = refusal({"sim", shot(), "--treads=2"});
    EXPECT_NE(command.find("no command 'simm'; did you mean 'sim'?"), std::string::npos) << command;
    EXPECT_NE(option.find("no option '--treads' of scree sim; did you mean '--threads'?"),
              std::string::npos)
        << option;
    EXPECT_EQ(runScree({"sim", shot(), "--frames", "5-1", "-o", take("x")}).code, 64);
    EXPECT_EQ(runScree({"sim", folder / "bad.toml", "-o", take("x")}).code, 65);
    EXPECT_EQ(runScree({"sim", folder / "missing.toml", "-o", take("x")}).code, 66);
    EXPECT_EQ(runScree({"info", folder / "missing"}).code, 66);
    EXPECT_EQ(runScree({"sim", shot(), "-o", "/proc/take"}).code, 73);
    EXPECT_FALSE(fs::exists(take("x")));
}

TEST_F(ProgramTest, FatalMessagesAndNothingElseBeginWithError)
{
    const Outcome wrong = runScree({"info", folder / "missing"});
    EXPECT_TRUE(wrong.err.starts_with("Error: ")) << wrong.err;
    EXPECT_TRUE(wrong.out.empty());
    const Outcome right = runScree({"sim", shot(), "-o", take("fine"), "--frames", "1003"});
    EXPECT_EQ(right.err.find("Error:"), std::string::npos) << right.err;
}

TEST_F(ProgramTest, HelpNamesEveryCommandAndEachCommandShowsAnExample)
{
    const Outcome help = runScree({"--help"});
    EXPECT_EQ(help.code, 0);
    for (const char* command :
         {"sim", "render", "export", "sheet", "movie", "check", "info", "explain"}) {
        EXPECT_TRUE(std::regex_search(help.out, std::regex("\n  " + std::string(command) + " ")))
            << command;
        const Outcome own = runScree({command, "--help"});
        EXPECT_EQ(own.code, 0);
        EXPECT_NE(own.out.find("Example:\n  scree " + std::string(command)), std::string::npos)
            << own.out;
    }
}

TEST_F(ProgramTest, VersionNamesTheLibraries)
{
    const Outcome outcome = runScree({"--version"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* word : {"scree ", "OpenVDB ", "Embree ", "Eigen ", "libpng "})
        EXPECT_TRUE(std::regex_search(outcome.out, std::regex(std::string(word) + "[0-9]")))
            << word << " in " << outcome.out;
}

TEST_F(ProgramTest, ProgressForAFarmOnlyGrowsAndEndsAtAHundred)
{
    const Outcome outcome = runScree({"sim", shot(), "-o", take("alf"), "--progress", "alf"});
    ASSERT_EQ(outcome.code, 0);
    std::istringstream lines(outcome.err);
    int last = -1;
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, std::regex("ALF_PROGRESS ([0-9]+)%"))) continue;
        EXPECT_GT(std::stoi(match[1]), last);
        last = std::stoi(match[1]);
    }
    EXPECT_EQ(last, 100);
}

TEST_F(ProgramTest, LogAsJsonIsOneObjectALine)
{
    const Outcome outcome = runScree({"sim", shot(), "-o", take("json"), "--frames", "1002",
                                      "--log-format", "json", "--progress", "json"});
    ASSERT_EQ(outcome.code, 0);
    std::istringstream lines(outcome.err);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        EXPECT_TRUE(line.starts_with("{") && line.ends_with("}")) << line;
    }
    EXPECT_GE(count, 2);
}

TEST_F(ProgramTest, ScriptReadsThePosesThatWereWritten)
{
    const std::string frame = take("script") + "/frames/frame.001001.scree";
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("script"), "--frames", "1001"}).code, 0);
    const std::string command = "/usr/bin/python3 '" +
                                test::sourceFile("tools/read_take.py").string() + "' '" + frame +
                                "' > '" + take("poses.txt") + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const std::string poses = readFileBytes(take("poses.txt"));
    EXPECT_TRUE(std::regex_search(poses, std::regex("high +position \\[0\\.3 +1\\.9 +0\\.1 *\\]")))
        << poses;
}

TEST_F(ProgramTest, TakeBecomesPicturesSheetFilmAndCache)
{
    const std::string output = take("shown");
    ASSERT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1001-1006"}).code, 0);
    const Outcome render =
        runScree({"render", output, "--size", "160x90", "--frames", "1001-1006x2"});
    EXPECT_EQ(render.code, 0) << render.err;
    EXPECT_TRUE(fs::exists(output + "/images/boxes.1003.png"));
    EXPECT_FALSE(fs::exists(output + "/images/boxes.1002.png"));
    const Outcome sheet =
        runScree({"sheet", output, "--frames", "1001-1006x2", "-o", take("sheet.png")});
    EXPECT_EQ(sheet.code, 0) << sheet.err;
    const Outcome spread = runScree({"sheet", output, "--frames", "1001-1005", "--count", "2",
                                     "--width", "100", "-o", take("spread.png")});
    EXPECT_EQ(spread.code, 0) << spread.err;
    EXPECT_LT(readPng(take("spread.png")).image.width, 3 * 100);
    const Outcome movie =
        runScree({"movie", output + "/images/boxes.####.png", "-o", take("film.mp4")});
    EXPECT_EQ(movie.code, 0) << movie.err;
    EXPECT_NE(movie.err.find("ffmpeg "), std::string::npos);
    EXPECT_GT(fs::file_size(take("film.mp4")), 500u);
    const Outcome cache =
        runScree({"export", output, "--frames", "1001-1006", "-o", take("boxes.abc")});
    EXPECT_EQ(cache.code, 0) << cache.err;
    EXPECT_GT(fs::file_size(take("boxes.abc")), 1000u);
}

// Whatever was made of the part that was there ended with 0 and no word.
TEST_F(ProgramTest, WhatIsMadeOfAnUnfinishedTakeSaysSoAndExitsWith66)
{
    const std::string output = take("t");
    ASSERT_EQ(runScree({"sim", shot(), "-o", output, "--frames", "1001-1005"}).code, 0);
    const std::vector<std::vector<std::string>> commands = {{"export", output, "-o", take("x.abc")},
                                                            {"render", output, "--size", "64x36"},
                                                            {"sheet", output, "-o", take("x.png")},
                                                            {"movie", output, "-o", take("x.mp4")}};
    for (std::vector<std::string> words : commands) {
        words.push_back("-q");
        const Outcome partial = runScree(words);
        EXPECT_EQ(partial.code, 66) << words[0] << ": " << partial.err;
        EXPECT_NE(partial.err.find("1006-1040"), std::string::npos) << partial.err;
        EXPECT_NE(partial.err.find("Warning: \""), std::string::npos) << partial.err;
        EXPECT_NE(partial.err.find("Error: \""), std::string::npos) << partial.err;
    }
    for (const char* name : {"x.abc", "x.png", "x.mp4"}) EXPECT_TRUE(fs::exists(take(name)));
    const Outcome asked =
        runScree({"export", output, "--frames", "1001-1005", "-o", take("y.abc"), "-q"});
    EXPECT_EQ(asked.code, 0) << asked.err;
    EXPECT_EQ(asked.err, "");
    const Outcome pattern =
        runScree({"movie", output + "/images/boxes.####.png", "-o", take("y.mp4"), "-q"});
    EXPECT_EQ(pattern.code, 0) << pattern.err;
    EXPECT_EQ(pattern.err, "");
}

// Overwriting a take with a branch of itself emptied it.
TEST_F(ProgramTest, ATakeIsNotOverwrittenByABranchOfItself)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1001-1005"}).code, 0);
    const std::vector<int> before = listFrames({take("t")});
    const Outcome itself =
        runScree({"sim", shot(), "--overwrite", "--from", take("t") + "@1003", "-o", take("t")});
    EXPECT_EQ(itself.code, 64) << itself.err;
    const Outcome missing =
        runScree({"sim", shot(), "--overwrite", "--from", take("no") + "@1003", "-o", take("t")});
    EXPECT_EQ(missing.code, 66) << missing.err;
    EXPECT_EQ(listFrames({take("t")}), before);
    EXPECT_TRUE(fs::exists(TakePaths{take("t")}.info()));
}

TEST_F(ProgramTest, ABranchKilledAtAnyInstantResumesToTheSameBytes)
{
    simulateUnbroken();
    const std::string from = take("unbroken") + "@1035", set = "material.wood.friction=0.1";
    ASSERT_EQ(runScree({"sim", shot(), "--from", from, "--set", set, "-o", take("branch")}).code,
              0);
    int cut = 0;  // of those that had begun and were not done
    // How long programs take to begin is the machine's business: the first is killed before, the
    // others so long after their take has appeared.
    const auto waitForTake = [&](const std::string& name) {
        for (int n = 0; n < 10000 && !fs::exists(take(name)); ++n) test::wait(1);
    };
    for (const int milliseconds : {-1, 0, 2, 10, 30, 60, 130}) {
        const std::string name = "killed" + std::to_string(milliseconds);
        Program program({"sim", shot(), "--from", from, "--set", set, "-o", take(name)});
        if (milliseconds >= 0) waitForTake(name);
        std::this_thread::sleep_for(std::chrono::milliseconds(std::max(milliseconds, 0)));
        program.signal(SIGKILL);
        program.wait();
        cut += fs::exists(take(name)) && !fs::exists(TakePaths{take(name)}.frame(1040));
        const Outcome resumed =
            runScree({"sim", shot(), "--from", from, "--set", set, "-o", take(name), "--resume"});
        EXPECT_EQ(resumed.code, 0) << resumed.err;
        expectSameFrames("branch", name);
    }
    EXPECT_GE(cut, 1);
}

/// The last line of the text that tells how to go on, from "scree" on.
std::string commandIn(const std::string& text)
{
    const std::size_t begin = text.find("scree sim");
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

TEST_F(ProgramTest, TheCommandThatIsPrintedGoesOnInAShell)
{
    const std::string spaced = take("two words");
    fs::create_directory(spaced);
    fs::copy(shot(), spaced + "/my boxes.toml");
    const std::vector<std::string> run = {
        "sim", spaced + "/my boxes.toml", "--set",     "material.wood.friction = 0.3",
        "-o",  spaced + "/take",          "--threads", "1"};
    Program program(run);
    ASSERT_TRUE(waitForFrame("two words/take", 1005));
    program.signal(SIGTERM);
    const Outcome stopped = program.wait();
    ASSERT_EQ(stopped.code, 75) << stopped.err;
    const std::string command = commandIn(stopped.err);
    ASSERT_FALSE(command.empty()) << stopped.err;
    const std::string path = fs::path(SCREE_PROGRAM).parent_path();
    EXPECT_EQ(std::system(("PATH='" + path + "' " + command + " 2> /dev/null > /dev/null").c_str()),
              0)
        << command;
    EXPECT_EQ(listFrames({spaced + "/take"}).back(), 1040);
}

/// A ring whose field takes long.
std::string slowShot(const std::string& segments, int resolution)
{
    return test::shotTextOf(
        {.name = "slow", .frames = "1001-1002"},
        "[shape.ring]\ntorus = { major = 1, minor = 0.3, segments = " + segments +
            " }\nsdf = { resolution = " + std::to_string(resolution) + " }\n" +
            test::bodyText("ring", "position = [0, 3, 0]", "ring"));
}

// The field of this ring takes seconds; signals before the first frame ended the program unheard.
TEST_F(ProgramTest, SignalsAreHeededWhileTheWorldIsBuilt)
{
    std::ofstream(take("slow.toml")) << slowShot("[400, 200]", 300);
    for (const int number : {SIGUSR1, SIGTERM}) {
        const Outcome outcome = signalled(
            {"sim", take("slow.toml"), "-o", take("slow"), "--no-cache", "--overwrite"}, number);
        EXPECT_EQ(outcome.code, number == SIGTERM ? 75 : 0) << outcome.err;
        const char* word =
            number == SIGTERM ? "stopped before the first frame" : "scree: still making the shapes";
        EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
        fs::remove_all(take("slow"));
    }
}

// One field takes half a minute, and asked nobody meanwhile: a farm kills what does not stop.
TEST_F(ProgramTest, AStopIsHeededWithinSecondsInsideOfOneField)
{
    std::ofstream(take("slow.toml")) << slowShot("[512, 512]", 512);
    const auto begun = std::chrono::steady_clock::now();
    Program program({"sim", take("slow.toml"), "-o", take("slow"), "--no-cache", "--threads", "1"});
    test::wait(4000);
    program.signal(SIGTERM);
    const Outcome outcome = program.wait();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
    EXPECT_EQ(outcome.code, 75) << outcome.err;
    EXPECT_NE(outcome.err.find("making the shapes of the shot\n"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("stopped before the first frame"), std::string::npos) << outcome.err;
    EXPECT_LT(taken.count(), 15.0);
    EXPECT_FALSE(fs::exists(take("slow")));
}

// Every resume of a finished take wrote all of a sequence anew.
TEST_F(ProgramTest, ExportsThatAreThereAreNotWrittenAgainByAResume)
{
    const std::vector<std::string> command = {"sim",     shot(),
                                              "-o",      take("t"),
                                              "--set",   "output.export=[\"obj\", \"abc\"]",
                                              "--set",   "shot.frames=\"1001-1003\"",
                                              "--resume"};
    ASSERT_EQ(runScree(command).code, 0);
    const std::string sequence = take("t") + "/exports/boxes.", cache = sequence + "abc";
    writeFileBytes(sequence + "1002.obj", "mine");
    writeFileBytes(cache, "mine");
    ASSERT_EQ(runScree(command).code, 0);
    EXPECT_EQ(readFileBytes(sequence + "1002.obj"), "mine");
    EXPECT_EQ(readFileBytes(cache), "mine");
    fs::remove(sequence + "1003.obj");
    ASSERT_EQ(runScree(command).code, 0);
    EXPECT_NE(readFileBytes(sequence + "1002.obj"), "mine") << "a sequence cut short is written";
    EXPECT_GT(fs::file_size(sequence + "1003.obj"), 100u);
}

TEST_F(ProgramTest, TakesOfOneMotionAreTheSameWhateverElseTheirShotsAskFor)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("a"), "--frames", "1003"}).code, 0);
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("b"), "--frames", "1003", "--set",
                        "output.contacts=true"})
                  .code,
              0);
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("c"), "--frames", "1002"}).code, 0);
    const Outcome other = runScree({"diff", take("a"), take("b")});
    EXPECT_EQ(other.code, 0) << other.out;
    EXPECT_NE(other.out.find("output.contacts"), std::string::npos) << other.out;
    EXPECT_EQ(runScree({"diff", take("a"), take("c")}).code, 1) << "a frame less";
}

TEST_F(ProgramTest, AFullDiskBehindStdoutExitsWith74)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1002"}).code, 0);
    const std::vector<std::vector<std::string>> commands = {
        {"check", shot(), "--json"},
        {"check", shot()},
        {"info", take("t")},
        {"explain", "solver"},
        {"diff", take("t"), take("t")},
        {"stats", take("t"), "--pictures", "0"},
        {"verify", "--list"},
        {"export", take("t"), "-o", take("t.abc")},
        {"--version"}};
    for (const std::vector<std::string>& words : commands) {
        const Outcome full =
            Program(words, [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); }).wait();
        EXPECT_EQ(full.code, 74) << words[0] << ": " << full.err;
        EXPECT_NE(full.err.find("stdout"), std::string::npos) << words[0] << ": " << full.err;
    }
}

TEST_F(ProgramTest, WhoeverReadsResultsMayStopWhenItHasEnough)
{
    const auto closePipe = [] {
        int ends[2];
        if (::pipe(ends) != 0) return;
        ::close(ends[0]);
        ::dup2(ends[1], STDOUT_FILENO);
    };
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"explain", "--all"}, {"--version"}}) {
        const Outcome gone = Program(words, closePipe).wait();
        EXPECT_EQ(gone.code, 0) << words[0] << ": " << gone.err;
        EXPECT_EQ(gone.err, "") << words[0];
    }
}

TEST_F(ProgramTest, NamesThatCannotBeReachedHaveTheCodeOfWhatTheyWereFor)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1002"}).code, 0);
    const std::string longName = take(std::string(300, 'n'));
    writeFileBytes(take("p.1001.png"), "");
    const std::vector<std::pair<int, std::vector<std::string>>> cases = {
        {73, {"sim", shot(), "-o", longName}},
        {73, {"export", take("t"), "-o", longName + ".abc"}},
        {73, {"stats", take("t"), "--pictures", "0", "-o", longName}},
        {73, {"verify", "E1", "-o", longName}},
        {73, {"movie", take("p.####.png"), "-o", longName + ".mp4"}},
        {66, {"sim", longName, "-o", take("x")}},
        {66, {"sim", shot(), "--from", longName + "@1001", "-o", take("x")}},
        {66, {"check", longName}},
        {66, {"info", longName}},
        {66, {"render", longName}},
        {66, {"diff", take("t"), longName}},
        {66, {"movie", longName, "-o", take("x.mp4")}},
        {64, {"sheet", take("t"), take("t"), "-o", take("x.png")}},
        {64, {"render", take("t"), "-o", take("p.####.jpg")}},
        {64, {"sheet", take("t"), "-o", take("x.jpg")}},
    };
    for (const auto& [code, words] : cases) {
        const Outcome outcome = runScree(words);
        EXPECT_EQ(outcome.code, code) << words[0] << ": " << outcome.err;
        EXPECT_EQ(outcome.err.find("internal"), std::string::npos) << outcome.err;
    }
}

TEST_F(ProgramTest, AShotThatMayNotBeReadSaysWhy)
{
    fs::permissions(folder.path(),
                    fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec);
    fs::permissions(shot(), fs::perms::none);
    // Root may read everything: as nobody it may not.
    const Outcome refused = Program({"check", shot()}, [] {
                                if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(126);
                            }).wait();
    if (refused.code == 126 || refused.code == 127) GTEST_SKIP() << "nobody may not run scree here";
    EXPECT_EQ(refused.code, 66) << refused.err;
    EXPECT_NE(refused.err.find("cannot be read: Permission denied"), std::string::npos)
        << refused.err;
}

TEST_F(ProgramTest, OptionsBeforeTheCommandChangeNoMessage)
{
    const std::vector<std::vector<std::string>> slips = {
        {"render", take("t"), "--frames", "1009", "--engine", "foo"},
        {"sim", shot(), "--overwrite", "--resume"},
        {"check", shot(), "--estimte", "3"},
        {"chekc", shot()}};
    for (const std::vector<std::string>& slip : slips) {
        const Outcome plain = runScree(slip);
        EXPECT_EQ(plain.code, 64);
        for (const std::vector<std::string>& options :
             std::vector<std::vector<std::string>>{{"-q"}, {"-v"}, {"--log-format", "text"}}) {
            std::vector<std::string> words = options;
            words.insert(words.end(), slip.begin(), slip.end());
            EXPECT_EQ(runScree(words).err, plain.err);
        }
    }
}

TEST_F(ProgramTest, ASpeedThatOverflowsIsToldInWordsAndItsFiguresAreKept)
{
    std::ofstream(take("fast.toml"))
        << test::shotTextOf({.name = "fast", .frames = "1001-1002"},
                            test::bodyText("b", "position = [0, 9, 0]\nvelocity = [1e300, 0, 0]"));
    const Outcome outcome = runScree({"sim", take("fast.toml"), "-o", take("t")});
    EXPECT_NE(outcome.err.find("faster than any number of steps"), std::string::npos)
        << outcome.err;
    const std::size_t lines = readStats(TakePaths{take("t")}.stats()).size();
    EXPECT_EQ(lines, listFrames({take("t")}).size());
    const Outcome resumed = runScree({"sim", take("fast.toml"), "-o", take("t"), "--resume"});
    EXPECT_EQ(resumed.err.find("no figures"), std::string::npos) << resumed.err;
    EXPECT_EQ(readStats(TakePaths{take("t")}.stats()).size(), lines);
}

TEST_F(ProgramTest, InfoSaysThatFiguresAreMissingInsteadOfShowingZeros)
{
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t"), "--frames", "1003"}).code, 0);
    EXPECT_EQ(runScree({"info", take("t")}).out.find("missing"), std::string::npos);
    fs::remove(TakePaths{take("t")}.stats());
    const std::string text = runScree({"info", take("t")}).out;
    EXPECT_NE(text.find("missing for 3 of 3 frames"), std::string::npos) << text;
    EXPECT_EQ(text.find("kinetic energy"), std::string::npos) << text;
    const std::string json = runScree({"info", take("t"), "--json"}).out;
    EXPECT_NE(json.find("\"worst_overlap_ratio\": null"), std::string::npos) << json;
    const Outcome resumed =
        runScree({"sim", shot(), "-o", take("t"), "--resume", "--frames", "1003"});
    EXPECT_NE(resumed.err.find("no figures for 3 frames"), std::string::npos) << resumed.err;
}

/// Waits until something stands in the folder.
bool waitForAnything(const fs::path& path)
{
    for (int i = 0; i < 20000; ++i) {
        if (!namesIn(path).empty()) return true;
        test::wait(1);
    }
    return false;
}

TEST_F(ProgramTest, AStoppedExportLeavesNoTemporary)
{
    std::ofstream(take("long.toml")) << test::shotTextOf(
        {.name = "long", .frames = "1001-2500"}, test::bodyText("b", "position = [0, 0.5, 0]"));
    ASSERT_EQ(runScree({"sim", take("long.toml"), "-o", take("t")}).code, 0);
    fs::create_directory(take("out"));
    Program program({"export", take("t"), "-o", take("out/long.usda")});
    ASSERT_TRUE(waitForAnything(take("out")));
    program.signal(SIGTERM);
    const Outcome stopped = program.wait();
    EXPECT_EQ(stopped.code, 75) << stopped.err;
    EXPECT_EQ(namesIn(take("out")), std::vector<std::string>());
}

// ffmpeg passed over it, and the film was a frame short.
TEST_F(ProgramTest, ADamagedPictureIsNamedAndNoFilmIsMade)
{
    fs::create_directory(take("out"));
    for (const int frame : {1001, 1002, 1003})
        writePng(take("p." + std::to_string(frame) + ".png"), Image(64, 64));
    const std::string damaged = take("p.1002.png");
    fs::resize_file(damaged, fs::file_size(damaged) / 2);
    const Outcome outcome = runScree({"movie", take("p.####.png"), "-o", take("out/x.mp4")});
    EXPECT_EQ(outcome.code, 74) << outcome.err;
    EXPECT_NE(outcome.err.find("p.1002.png"), std::string::npos) << outcome.err;
    EXPECT_EQ(namesIn(take("out")), std::vector<std::string>());
}

// Any ending gave an MP4 under its name.
TEST_F(ProgramTest, TheEndingOfAFilmDecidesItsContainerOrIsRefused)
{
    writePng(take("p.1001.png"), Image(64, 64));
    ASSERT_EQ(runScree({"movie", take("p.####.png"), "-o", take("x.mov")}).code, 0);
    ASSERT_EQ(runScree({"movie", take("p.####.png"), "-o", take("x.mp4")}).code, 0);
    EXPECT_EQ(readFileBytes(take("x.mov")).substr(4, 6), "ftypqt");
    EXPECT_EQ(readFileBytes(take("x.mp4")).substr(4, 7), "ftypiso");
    const Outcome refused = runScree({"movie", take("p.####.png"), "-o", take("x.avi")});
    EXPECT_EQ(refused.code, 64);
    EXPECT_NE(refused.err.find(".mp4, .m4v, .mov"), std::string::npos) << refused.err;
}

TEST_F(ProgramTest, WhatLooksOrDrawsStopsWith75Too)
{
    std::ofstream(take("slow.toml")) << test::shotTextOf(
        {.name = "slow", .frames = "1001-1002"},
        "[shape.ring]\ntorus = { major = 1, minor = 0.3, segments = [400, 200] }\n"
        "sdf = { resolution = 400 }\n" +
            test::bodyText("ring", "position = [0, 3, 0]", "ring"));
    ASSERT_EQ(runScree({"sim", shot(), "-o", take("t")}).code, 0);
    const std::vector<std::vector<std::string>> commands = {
        {"check", take("slow.toml"), "--no-cache"},
        {"sheet", take("t"), "--count", "40", "--width", "4096", "-o", take("out.png")},
        {"stats", take("t"), "--pictures", "1000", "-o", take("out.html")}};
    for (const std::vector<std::string>& words : commands) {
        const Outcome stopped = signalled(words, SIGTERM);
        EXPECT_EQ(stopped.code, 75) << words[0] << ": " << stopped.err;
        EXPECT_NE(stopped.err.find("stopped"), std::string::npos) << stopped.err;
    }
    EXPECT_FALSE(fs::exists(take("out.png")) || fs::exists(take("out.html")));
}

// A program of that name stands in for ffmpeg: it writes half a film and never ends by itself.
TEST_F(ProgramTest, AStoppedMovieStopsFfmpegAndLeavesNoTemporary)
{
    fs::create_directory(take("out"));
    fs::create_directory(take("bin"));
    writePng(take("p.1001.png"), Image(4, 4));
    writeFileBytes(take("bin/ffmpeg"),
                   "#!/bin/sh\nfor last; do :; done\necho half > \"$last\"\nexec sleep 60\n");
    fs::permissions(take("bin/ffmpeg"), fs::perms::owner_all);
    Program program({"movie", take("p.####.png"), "-o", take("out/x.mp4")},
                    [&] { ::setenv("PATH", (take("bin") + ":/usr/bin:/bin").c_str(), 1); });
    ASSERT_TRUE(waitForAnything(take("out")));
    test::wait(100);
    program.signal(SIGTERM);
    const Outcome stopped = program.wait();
    EXPECT_EQ(stopped.code, 75) << stopped.err;
    EXPECT_EQ(namesIn(take("out")), std::vector<std::string>());
}

}  // namespace
}  // namespace scree
