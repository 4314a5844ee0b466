// The page of a take's statistics: whole in itself, and alive in a browser.
#include "tools/stats_page.h"

#include <gtest/gtest.h>

#include "io/file_bytes.h"
#include "tests/support/readers.h"
#include "tests/support/support.h"
#include "tools/html_text.h"

namespace scree {
namespace test {
namespace {

std::vector<std::uint8_t> bytesOf(const std::string& text)
{
    return {text.begin(), text.end()};
}

TEST(StatsPage, Base64FollowsTheStandardsExamples)
{
    EXPECT_EQ(base64(bytesOf("")), "");
    EXPECT_EQ(base64(bytesOf("f")), "Zg==");
    EXPECT_EQ(base64(bytesOf("fo")), "Zm8=");
    EXPECT_EQ(base64(bytesOf("foobar")), "Zm9vYmFy");
    EXPECT_EQ(base64({0xff, 0xef, 0xfe}), "/+/+");
}

/// A take of three frames and its page.
std::string pageOfAShortTake(const TemporaryFolder& folder)
{
    const std::string take = quoted(folder / "take"), page = quoted(folder / "stats.html");
    const CommandResult made = runCommand(
        std::string(SCREE_PROGRAM) + " -q sim " + quoted(sourceFile("shots/stack_10.toml")) +
        " --set 'shot.frames=\"1001-1003\"' -o " + take + " && " + SCREE_PROGRAM + " stats " +
        take + " --pictures 2 -o " + page);
    EXPECT_EQ(made.exitCode, 0) << made.output;
    return readFileBytes(folder / "stats.html");
}

TEST(StatsPage, AsksForNothingOutsideAndHoldsAllFrames)
{
    const TemporaryFolder folder;
    const std::string page = pageOfAShortTake(folder);
    for (const char* outside : {"http:", "https:", "url(", "import(", "fetch(", "{{"})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
    for (const char* inside :
         {"\"frame\":1001", "\"frame\":1003", "[material.wood]", "iVBORw0KGgo"})
        EXPECT_NE(page.find(inside), std::string::npos) << inside;
}

TEST(StatsPage, DrawsItsPlotsInABrowser)
{
    const CommandResult browser = runCommand(
        "command -v chromium || command -v chromium-browser || command -v google-chrome");
    SCREE_REQUIRE_READER(browser.exitCode == 0, "chromium: apt-get install chromium");
    const TemporaryFolder folder;
    pageOfAShortTake(folder);
    const CommandResult shown = runCommand(
        "timeout 60 " + browser.output.substr(0, browser.output.find('\n')) +
        " --headless --no-sandbox --disable-gpu --user-data-dir=" + quoted(folder / "profile") +
        " --dump-dom " + "file://" + quoted(folder / "stats.html"));
    // The script sets this when it has come to its end: how many plots have a canvas.
    EXPECT_NE(shown.output.find("data-ready=\"7\""), std::string::npos)
        << shown.output.substr(0, 400);
    EXPECT_NE(shown.output.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(shown.output.find("<td>1003</td>"), std::string::npos);
}

}  // namespace
}  // namespace test
}  // namespace scree
