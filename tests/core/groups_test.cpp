#include "core/base/groups.h"

#include <gtest/gtest.h>

#include <vector>

namespace scree::test {
namespace {

std::vector<std::size_t> listed(std::span<const std::size_t> group)
{
    return {group.begin(), group.end()};
}

TEST(Groups, KeepTheOrderOfTheirItemsAndLeaveOutWhatBelongsToNone)
{
    const std::vector<std::size_t> items = {12, 7, 3, 20, 6, 9, 1, 15};
    Groups groups;
    // By the remainder, of which 1 is no group: those would be in the third of two.
    groups.sort(items, 2, [](std::size_t item) { return item % 3 == 1 ? 2 : item % 3 / 2; });
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(listed(groups[0]), (std::vector<std::size_t>{12, 3, 6, 9, 15}));
    EXPECT_EQ(listed(groups[1]), (std::vector<std::size_t>{20}));
}

TEST(Groups, RememberNothingOfWhatTheyHeldBefore)
{
    const std::vector<std::size_t> many = {0, 1, 2, 3, 4, 5}, few = {8};
    Groups groups;
    groups.sort(many, 3, [](std::size_t item) { return item / 2; });
    groups.sort(few, 2, [](std::size_t) { return 1; });
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_TRUE(groups[0].empty());
    EXPECT_EQ(listed(groups[1]), few);
    groups.sort({}, 0, [](std::size_t) { return 0; });
    EXPECT_EQ(groups.size(), 0u);
}

}  // namespace
}  // namespace scree::test
