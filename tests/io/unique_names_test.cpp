#include "io/unique_names.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(UniqueNames, PlainNamesStayAsTheyAre)
{
    UniqueNames names;
    for (const char* name : {"ring_0042", "_x", "A"}) EXPECT_EQ(names.take(name), name);
}

TEST(UniqueNames, OtherNamesBecomePlainOnes)
{
    UniqueNames names;
    for (const char* name : {"", "9lives", "a b", "a.b",
                             "r\xc3\xb8"
                             "d",
                             "a/b"}) {
        EXPECT_TRUE(isPlainName(names.take(name))) << name;
    }
}

TEST(UniqueNames, NoTwoNamesAreEqual)
{
    UniqueNames names;
    EXPECT_EQ(names.take("a_b"), "a_b");
    EXPECT_EQ(names.take("a_b_2"), "a_b_2");
    EXPECT_EQ(names.take("a b"), "a_b_3");
    EXPECT_EQ(names.take("a.b"), "a_b_4");
}

}  // namespace
}  // namespace scree
