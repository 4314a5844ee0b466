// A run that was interrupted ends as one that was not: figures, exit code, what was made of it.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/file_bytes.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"
#include "tests/tools/program_fixture.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::Program;
using test::runScree;

class InterruptionTest : public test::ProgramFixture {
protected:
    /// Two blocks in each other that sleep, of which no contact tells, and one that falls.
    std::string overlappingShot() const
    {
        return shotFile(
            "s.toml",
            test::shotTextOf(
                {.frames = "1001-1020",
                 .shotKeys = "[start]\noverlap = \"warn\"\n[solver]\npenetration = { fail = 0.3 }\n"
                             "substeps = { min = 250, max = 256 }"},
                test::bodyText("a", "position = [4, 2, 0]\nstart = \"asleep\"") +
                    test::bodyText("b", "position = [4.5, 2.1, 0]\nstart = \"asleep\"") +
                    test::bodyText("block", "position = [0, 0.6, 0]\nrotation = [20, 0, 10]")));
    }

    /// stats.jsonl without what an interruption may change: times.
    std::vector<nlohmann::json> figuresOf(const std::string& take) const
    {
        std::vector<nlohmann::json> lines;
        std::ifstream stream(TakePaths{take}.stats());
        for (std::string line; std::getline(stream, line);) {
            nlohmann::json json = nlohmann::json::parse(line);
            for (const char* key : {"wall_s", "cpu_s", "phase_ms", "resumed_at_substep"})
                json.erase(key);
            // A sum in two parts is rounded otherwise.
            json["push_out_work_J"] = std::round(1e9 * json["push_out_work_J"].get<double>());
            lines.push_back(json);
        }
        return lines;
    }
};

// Overlaps that a look at all poses had found were forgotten by the next sitting, and the steps of
// a frame before a stop were: a breach of a limit was told or not by where the run was stopped.
TEST_F(InterruptionTest, FiguresAndExitCodeAreThoseOfAnUnbrokenRun)
{
    const std::string shot = overlappingShot();
    const Outcome unbroken = runScree({"sim", shot, "-o", file("unbroken"), "-q"});
    EXPECT_EQ(unbroken.code, 79) << unbroken.err;
    const std::vector<nlohmann::json> figures = figuresOf(file("unbroken"));
    ASSERT_EQ(figures.size(), 20u);

    for (const char* frames : {"1001", "1001-1005"})
        runScree({"sim", shot, "-o", file("parts"), "-q", "--resume", "--frames", frames});
    EXPECT_EQ(runScree({"sim", shot, "-o", file("parts"), "-q", "--resume"}).code, 79);
    EXPECT_EQ(figuresOf(file("parts")), figures);

    const Sittings stopped = runInSittings({"sim", shot, "-o", file("stopped"), "-q", "--resume"});
    EXPECT_EQ(stopped.last.code, 79) << stopped.last.err;
    EXPECT_GT(stopped.stops, 0);
    EXPECT_EQ(figuresOf(file("stopped")), figures);
}

// It was asked between the sub-steps of a frame alone, and many frames have but one.
TEST_F(InterruptionTest, SettleStopsThoughItsFramesAreOfOneStep)
{
    shotFile("s.toml", test::shotTextOf(
                           {.shotKeys = "gravity = [0, 0, 0]"},
                           test::bodyText("block", "position = [0, 9, 0]\nvelocity = [1, 0, 0]")));
    Program program({"settle", file("s.toml"), "-o", file("s.json"), "--seconds", "1000000",
                     "--progress", "alf"});
    test::wait(1500);
    program.signal(SIGUSR1);
    test::wait(500);
    program.signal(SIGTERM);
    // Unheeded, it would go on for minutes.
    std::atomic<bool> isOver = false;
    std::thread impatience([&] {
        for (int i = 0; i < 100 && !isOver; ++i) test::wait(100);
        if (!isOver) program.signal(SIGKILL);
    });
    const Outcome stopped = program.wait();
    isOver = true;
    impatience.join();
    EXPECT_EQ(stopped.code, 75) << stopped.err;
    EXPECT_NE(stopped.err.find("ALF_PROGRESS 0%"), std::string::npos) << stopped.err;
    EXPECT_NE(stopped.err.find("scree: saved in frame "), std::string::npos) << stopped.err;
    EXPECT_NE(stopped.err.find("--resume"), std::string::npos) << stopped.err;
    EXPECT_FALSE(fs::exists(file("s.json")));
}

// It ended with 75, which says that a run can be gone on with, and began anew.
TEST_F(InterruptionTest, SettleGoesOnToThePoseOfARunThatWasNotStopped)
{
    shotFile("s.toml",
             test::shotTextOf(
                 {.shotKeys = "[solver]\nsubsteps = { min = 500, max = 1000 }"},
                 test::bodyText("low", "position = [0, 0.9, 0]\nrotation = [20, 0, 10]") +
                     test::bodyText("high", "position = [0.2, 2.6, 0.1]\nrotation = [5, 0, 40]")));
    const std::vector<std::string> start = {"settle", file("s.toml"), "-q", "-o"};
    const auto settle = [&](const std::string& output) {
        std::vector<std::string> words = start;
        words.insert(words.end(), {file(output), "--resume"});
        return words;
    };
    const Outcome unbroken = runScree(settle("unbroken.json"));
    ASSERT_EQ(unbroken.code, 0) << unbroken.err;
    EXPECT_FALSE(fs::exists(file("unbroken.json.checkpoint")));

    const Sittings stopped = runInSittings(settle("stopped.json"));
    EXPECT_EQ(stopped.last.code, 0) << stopped.last.err;
    EXPECT_GT(stopped.stops, 1);
    EXPECT_EQ(readFileBytes(file("stopped.json")), readFileBytes(file("unbroken.json")));
    EXPECT_FALSE(fs::exists(file("stopped.json.checkpoint")));
}

TEST_F(InterruptionTest, SettleGoesOnWithNoCheckpointOfAnotherShot)
{
    const auto shot = [&](const char* place) {
        shotFile("s.toml",
                 test::shotTextOf({.shotKeys = "gravity = [0, 0, 0]"},
                                  test::bodyText("block", "velocity = [1, 0, 0]\nposition = " +
                                                              std::string(place))));
    };
    shot("[0, 9, 0]");
    Program program({"settle", file("s.toml"), "-o", file("s.json"), "--seconds", "1000000"});
    test::wait(800);
    program.signal(SIGTERM);
    ASSERT_EQ(program.wait().code, 75);
    const std::string kept = readFileBytes(file("s.json.checkpoint"));
    const std::vector<std::string> again = {
        "settle", file("s.toml"), "-o", file("s.json"), "--seconds", "1", "--resume"};
    shot("[0, 8, 0]");
    const Outcome other = runScree(again);
    EXPECT_EQ(other.code, 65) << other.err;
    EXPECT_NE(other.err.find("is of another shot"), std::string::npos) << other.err;
    shot("[0, 9, 0]");
    for (const std::string& bytes : {kept.substr(0, kept.size() / 2), kept + "x"}) {
        writeFileBytes(file("s.json.checkpoint"), bytes);
        EXPECT_EQ(runScree(again).code, 74) << bytes.size();
    }
    // What is somebody else's is neither replaced nor removed.
    for (const std::string mine : {"mine", ""}) {
        writeFileBytes(file("s.json.checkpoint"), mine);
        EXPECT_EQ(runScree(again).code, 73);
        EXPECT_EQ(runScree({"settle", file("s.toml"), "-o", file("s.json")}).code, 73);
        EXPECT_EQ(readFileBytes(file("s.json.checkpoint")), mine);
    }
}

// One that failed left that of an earlier take, which a resume believed.
TEST_F(InterruptionTest, AnExportOlderThanItsFramesIsWrittenAgain)
{
    shotFile("s.toml", test::shotTextOf({.frames = "1001-1003"},
                                        test::bodyText("block", "position = [0, 0.6, 0]")));
    const std::vector<std::string> command = {
        "sim", file("s.toml"), "-o", file("t"), "--set", "output.export=[\"abc\"]", "--resume"};
    ASSERT_EQ(runScree(command).code, 0);
    const fs::path cache = file("t") + "/exports/s.abc";
    writeFileBytes(cache, "of an earlier take");
    const auto simulated = fs::last_write_time(TakePaths{file("t")}.frame(1003));
    fs::last_write_time(cache, simulated - std::chrono::seconds(1));
    ASSERT_EQ(runScree(command).code, 0);
    EXPECT_NE(readFileBytes(cache), "of an earlier take");
}

}  // namespace
}  // namespace scree
