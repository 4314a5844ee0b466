// The page about all keys is made from the schema and must not fall behind it.
#include <gtest/gtest.h>

#include "io/file_bytes.h"
#include "io/shot_reference.h"
#include "io/shot_schema.h"
#include "tests/support/support.h"

namespace scree {
namespace {

TEST(ShotReference, ThePageInTheRepositoryIsWhatTheSchemaSays)
{
    EXPECT_TRUE(readFileBytes(test::sourceFile("shots/REFERENCE.md")) == shotReference())
        << "run: build/scree explain --all > shots/REFERENCE.md";
}

TEST(ShotReference, NamesEveryKeyAndItsHelp)
{
    const std::string text = shotReference();
    for (const ShotKey& key : shotKeys()) {
        EXPECT_NE(text.find(key.help), std::string::npos) << key.path;
        const bool isTable = key.type == KeyType::namedTables || key.type == KeyType::tableList;
        const std::string name = (isTable ? "[" : "`") + std::string(key.path);
        EXPECT_NE(text.find(name), std::string::npos) << key.path;
    }
}

}  // namespace
}  // namespace scree
