#include "io/shot_difference.h"

#include <gtest/gtest.h>

#include "tests/support/small_shot.h"

namespace scree {
namespace {

/// Of two small shots, told from the first.
std::vector<std::string> between(const test::SmallShot& ours, const std::string& ourBodies,
                                 const test::SmallShot& theirs, const std::string& theirBodies)
{
    const Shot a = parseShotText(test::shotTextOf(ours, ourBodies), "a.toml");
    const Shot b = parseShotText(test::shotTextOf(theirs, theirBodies), "b.toml");
    return shotDifferences(a.resolvedText, b.resolvedText, "the take");
}

// "the resolved shot has hash 324816ddb464cec7, the take's is d02b5945d22ff21c" told nobody that
// the shot had been made longer.
TEST(ShotDifference, NamesTheKeyAndBothValues)
{
    const test::SmallShot longer{.frames = "1001-1300"};
    const std::string body = test::bodyText("box", "position = [0, 1, 0]");
    EXPECT_EQ(
        between(longer, body, {}, body),
        std::vector<std::string>({"shot.frames = \"1001-1300\" (the take has \"1001-1006\")"}));
}

TEST(ShotDifference, NamesBodiesByTheirNames)
{
    const std::string first = test::bodyText("a", "position = [0, 1, 0]"),
                      second = test::bodyText("b", "position = [3, 1, 0]"),
                      moved = test::bodyText("b", "position = [4, 1, 0]");
    EXPECT_EQ(between({}, first + moved, {}, first + second),
              std::vector<std::string>(
                  {"body.b.position = [4.0, 1.0, 0.0] (the take has [3.0, 1.0, 0.0])"}));
}

// Of long values both beginnings were told, which are the same.
TEST(ShotDifference, TellsOfLongValuesWhereTheyPart)
{
    const auto keyed = [](const std::string& last) {
        return test::bodyText("a",
                              "motion = \"keyed\"\nkeys = [{ frame = 1001, position = [0, 1, 0] }, "
                              "{ frame = 1003, position = [0, 2, 0] }, { frame = 1006, position = "
                              "[0, " +
                                  last + ", 0] }]");
    };
    const std::vector<std::string> told = between({}, keyed("3"), {}, keyed("4"));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0],
              "body.a.keys = ...0, position = [0.0, 3.0, 0.0] }] (the take has ...0, "
              "position = [0.0, 4.0, 0.0] }])");
}

TEST(ShotDifference, TellsWhatOnlyOneHas)
{
    const std::string body = test::bodyText("a", "position = [0, 1, 0]"),
                      heavy = test::bodyText("a", "position = [0, 1, 0]\nmass = 2");
    EXPECT_EQ(between({}, heavy, {}, body),
              std::vector<std::string>({"body.a.mass = 2.0 (the take has none)"}));
    EXPECT_EQ(between({}, body, {}, heavy),
              std::vector<std::string>({"no body.a.mass (the take has 2.0)"}));
}

TEST(ShotDifference, AFewAreToldAndTheRestCounted)
{
    EXPECT_EQ(someDifferences({"a"}), "a");
    EXPECT_EQ(someDifferences({"a", "b", "c"}), "a, b, c");
    EXPECT_EQ(someDifferences({"a", "b", "c", "d", "e"}), "a, b, c and 2 more");
}

}  // namespace
}  // namespace scree
