#include "tools/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>
#include <vector>

#include "tools/parts_progress.h"

namespace scree {
namespace {

/// What is told on stderr of frames that `tell` reports. Tests' stderr is no terminal.
template <class Tell>
std::string told(ProgressMode mode, int frameCount, int framesDone, Tell tell,
                 LogFormat format = LogFormat::text)
{
    testing::internal::CaptureStderr();
    {
        Console console;
        console.format = format;
        Progress progress(console, mode, "sim", frameCount, framesDone);
        tell(progress);
    }
    return testing::internal::GetCapturedStderr();
}

/// The last line, as JSON.
nlohmann::json lastJson(const std::string& text)
{
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);) last = line;
    return nlohmann::json::parse(last);
}

// Control codes are rubbish there, whoever asks for them.
TEST(Progress, ADumbTerminalGetsLinesEvenWhereARedrawnOneIsAskedFor)
{
    ::setenv("TERM", "dumb", 1);
    const std::string text =
        told(ProgressMode::tty, 2, 0, [](Progress& progress) { progress.frameDone(1001, 1.0); });
    ::unsetenv("TERM");
    EXPECT_EQ(text, "ALF_PROGRESS 50%\n");
}

// It was 97 columns wide, wrapped, and filled the terminal with its remains.
TEST(Progress, TheLineFitsEightyColumnsWhateverItTells)
{
    for (const ProgressFigures figures :
         {ProgressFigures{}, ProgressFigures{2, 0}, ProgressFigures{1000, 12345},
          ProgressFigures{100000, 1234567890}}) {
        for (const double seconds : {0.1, 59.0, 3599.0, 86000.0}) {
            const std::string text = told(ProgressMode::tty, 1000, 0, [&](Progress& progress) {
                progress.frameDone(1001, seconds, figures);
                progress.frameDone(100002, seconds, figures);
            });
            const std::regex redrawn("\r\033\\[K");
            std::sregex_token_iterator line(text.begin(), text.end(), redrawn, -1), end;
            int lines = 0;
            for (; line != end; ++line) {
                const std::string shown = *line;
                lines += !shown.empty();
                EXPECT_LT(shown.size(), 80u) << shown;
                const bool tellsWhatIsLeft = shown.find("left ") != std::string::npos;
                EXPECT_TRUE(shown.empty() || tellsWhatIsLeft) << shown;
            }
            EXPECT_GE(lines, 1);
        }
    }
}

// The rest of a frame, done in a second, promised that every frame takes no longer.
TEST(Progress, AFrameThatWasResumedHalfWayCountsAsTheWholeOfIt)
{
    const auto resumed = lastJson(told(ProgressMode::json, 10, 4, [](Progress& progress) {
        progress.frameDone(1005, 2.0, {}, 0.25);
    }));
    EXPECT_DOUBLE_EQ(resumed["seconds_per_frame"].get<double>(), 8.0);
    EXPECT_DOUBLE_EQ(resumed["seconds_left"].get<double>(), 40.0);
}

TEST(Progress, WhatIsLeftIsUnknownBeforeAFrameWasTimed)
{
    const auto first = lastJson(told(ProgressMode::json, 10, 0, [](Progress& progress) {
        progress.frameDone(1001, 0.0, {}, 0.0);
    }));
    EXPECT_TRUE(first["seconds_per_frame"].is_null());
    EXPECT_TRUE(first["seconds_left"].is_null());
}

TEST(Progress, TheNewestFrameHasAFifthOfTheSayInWhatIsLeft)
{
    const auto second = lastJson(told(ProgressMode::json, 4, 0, [](Progress& progress) {
        progress.frameDone(1001, 1.0);
        progress.frameDone(1002, 6.0);
    }));
    EXPECT_DOUBLE_EQ(second["seconds_per_frame"].get<double>(), 0.8 * 1.0 + 0.2 * 6.0);
    EXPECT_DOUBLE_EQ(second["seconds_left"].get<double>(), 2 * 2.0);
}

TEST(Progress, ALogOfJsonHoldsNothingElse)
{
    const std::string text = told(
        ProgressMode::automatic, 4, 0, [](Progress& progress) { progress.frameDone(1001, 1.0); },
        LogFormat::json);
    EXPECT_EQ(lastJson(text)["progress"], 25) << text;
    EXPECT_EQ(text.find("ALF"), std::string::npos) << text;
}

/// The lines that are told on stderr of parts that `tell` does, one a moment silence being too
/// long.
template <class Tell>
std::vector<std::string> partsTold(ProgressMode mode, Tell tell)
{
    testing::internal::CaptureStderr();
    {
        Console console;
        PartsProgress progress(console, mode, 4, std::chrono::milliseconds(60));
        tell(progress);
    }
    std::istringstream text(testing::internal::GetCapturedStderr());
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

void wait(int milliseconds)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// A farm took the silence of an experiment, or of ffmpeg, for a hang.
TEST(PartsProgress, SaysTheSameAgainWhileAPartLasts)
{
    const std::vector<std::string> lines = partsTold(ProgressMode::alf, [](auto& progress) {
        progress.partDone();
        wait(400);
        progress.partDone();
    });
    ASSERT_GE(lines.size(), 4u);
    EXPECT_EQ(lines.front(), "ALF_PROGRESS 25%");
    EXPECT_EQ(lines[lines.size() - 2], "ALF_PROGRESS 25%");
    EXPECT_EQ(lines.back(), "ALF_PROGRESS 50%");
}

TEST(PartsProgress, UnaskedSaysNothingOfWhatIsSoonDone)
{
    const auto quick = [](auto& progress) { progress.partDone(); };
    EXPECT_TRUE(partsTold(ProgressMode::automatic, quick).empty());
    EXPECT_TRUE(partsTold(ProgressMode::none, quick).empty());
    const auto slow = [](auto& progress) {
        wait(200);
        progress.partDone();
    };
    EXPECT_EQ(partsTold(ProgressMode::automatic, slow).front(), "ALF_PROGRESS 0%");
    EXPECT_EQ(partsTold(ProgressMode::automatic, slow).back(), "ALF_PROGRESS 25%");
    EXPECT_EQ(partsTold(ProgressMode::json, slow).back(), "{\"progress\":25}");
}

}  // namespace
}  // namespace scree
