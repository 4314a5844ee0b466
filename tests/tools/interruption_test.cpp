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
#include "io/take.h"
#include "tests/support/program.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::Program;
using test::runScree;

class InterruptionTest : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (folder / name).string(); }

    /// Two blocks in each other that sleep, of which no contact tells, and one that falls.
    std::string overlappingShot() const
    {
        const std::string path = file("s.toml");
        std::ofstream(path) << test::shotTextOf(
            {.frames = "1001-1020",
             .shotKeys = "[start]\noverlap = \"warn\"\n[solver]\npenetration = { fail = 0.3 }\n"
                         "substeps = { min = 60, max = 256 }"},
            test::bodyText("a", "position = [4, 2, 0]\nstart = \"asleep\"") +
                test::bodyText("b", "position = [4.5, 2.1, 0]\nstart = \"asleep\"") +
                test::bodyText("block", "position = [0, 0.6, 0]\nrotation = [20, 0, 10]"));
        return path;
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

    test::TemporaryFolder folder;
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

    int stops = 0;
    for (int tries = 0; tries < 200; ++tries) {
        Program program({"sim", shot, "-o", file("stopped"), "-q", "--resume"});
        std::this_thread::sleep_for(std::chrono::milliseconds(60 + 7 * tries));
        if (tries % 3 == 1) program.signal(SIGUSR1);
        program.signal(SIGTERM);
        const Outcome outcome = program.wait();
        stops += outcome.code == 75;
        if (outcome.code == 79) break;
    }
    EXPECT_GT(stops, 0);
    EXPECT_EQ(figuresOf(file("stopped")), figures);
}

// It was asked between the sub-steps of a frame alone, and many frames have but one.
TEST_F(InterruptionTest, SettleStopsThoughItsFramesAreOfOneStep)
{
    std::ofstream(file("s.toml")) << test::shotTextOf(
        {.shotKeys = "gravity = [0, 0, 0]"},
        test::bodyText("block", "position = [0, 9, 0]\nvelocity = [1, 0, 0]"));
    Program program({"settle", file("s.toml"), "-o", file("s.json"), "--seconds", "1000000",
                     "--progress", "alf"});
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    program.signal(SIGUSR1);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    program.signal(SIGTERM);
    // Unheeded, it would go on for minutes.
    std::atomic<bool> isOver = false;
    std::thread impatience([&] {
        for (int i = 0; i < 100 && !isOver; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        if (!isOver) program.signal(SIGKILL);
    });
    const Outcome stopped = program.wait();
    isOver = true;
    impatience.join();
    EXPECT_EQ(stopped.code, 75) << stopped.err;
    EXPECT_NE(stopped.err.find("ALF_PROGRESS 0%"), std::string::npos) << stopped.err;
    EXPECT_NE(stopped.err.find("scree: in frame "), std::string::npos) << stopped.err;
    EXPECT_NE(stopped.err.find("nothing was written"), std::string::npos) << stopped.err;
    EXPECT_FALSE(fs::exists(file("s.json")));
}

// One that failed left that of an earlier take, which a resume believed.
TEST_F(InterruptionTest, AnExportOlderThanItsFramesIsWrittenAgain)
{
    std::ofstream(file("s.toml")) << test::shotTextOf(
        {.frames = "1001-1003"}, test::bodyText("block", "position = [0, 0.6, 0]"));
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
