#include "io/take_folder.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "io/file_bytes.h"
#include "tests/support/support.h"

namespace scree {
namespace {

// A copy that somebody had made by hand counted as a second frame of that number.
TEST(TakeFolder, WhatIsNamedAlmostAsAFrameIsNone)
{
    const test::TemporaryFolder folder;
    const TakePaths paths{folder.path()};
    createFolder(paths.frames());
    for (const char* name :
         {"frame.001002.scree", "frame.1002.scree", "frame.0001002.scree", "frame.-00003.scree",
          "frame.-3.scree", "frame.001003.scree~", "frame.1e3.scree", "frame..scree",
          "frame.1234567.scree", "FRAME.001004.scree", "frame.99999999999.scree"})
        writeFileBytes(paths.frames() / name, "");
    EXPECT_EQ(listFrames(paths), (std::vector<int>{-3, 1002, 1234567}));
    EXPECT_TRUE(holdsTake(paths));
}

TEST(TakeFolder, IsLockedForOneAtATime)
{
    const test::TemporaryFolder folder;
    const TakePaths paths{folder.path()};
    {
        const TakeLock lock(paths);
        EXPECT_THROW(TakeLock second(paths), Error);
    }
    const TakeLock again(paths);
}

}  // namespace
}  // namespace scree
