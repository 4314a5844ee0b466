// What a power cut leaves of a take: names are durable only once their folder is synced.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <set>

#include "io/take_folder.h"
#include "tests/io/take_fixture.h"

namespace {

namespace fs = std::filesystem;

bool keepsAccount = false;
std::set<fs::path> durable;  // names that a sync of their folder has found there

}  // namespace

/// Stands before the C library's in this program: keeps account of folders.
extern "C" int fsync(int descriptor)
{
    std::error_code code;
    const fs::path folder = fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), code);
    if (keepsAccount && !code && fs::is_directory(folder, code))
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            durable.insert(entry.path());
    return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

namespace scree {
namespace {

class TakeDurability : public test::TakeFixture {
protected:
    TakeDurability()
    {
        durable.clear();
        keepsAccount = true;
    }
    ~TakeDurability() override { keepsAccount = false; }
};

// stats.jsonl and the folders beside it were made after the last sync of the take's own: its frames
// were on the disk, and nothing led to them.
TEST_F(TakeDurability, AllThatLeadsToTheFirstFrameOfANewTakeIsDurableWithIt)
{
    const fs::path root = fs::canonical(folder.path()) / "takes" / "new";
    TakeWriter take(root, shot, world, "1.2.3", ExistingTake::refuse);
    take.writeFrame(world, statsOf(world));
    EXPECT_TRUE(durable.contains(root.parent_path()));
    EXPECT_TRUE(durable.contains(root));
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
        EXPECT_TRUE(durable.contains(entry.path())) << entry.path();
}

TEST_F(TakeDurability, FoldersThatWereThereAreNotSyncedAgain)
{
    createFolder(folder / "a/b");
    EXPECT_FALSE(durable.empty());
    durable.clear();
    createFolder(folder / "a/b/");
    EXPECT_TRUE(durable.empty());
}

}  // namespace
}  // namespace scree
