#include "io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "core/base/error.h"
#include "io/frame_writer.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

using test::contentOf;

std::size_t fileCount(const fs::path& folder)
{
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// A disk that is full after some bytes: the system refuses writes beyond them, to any user.
class SmallDisk {
public:
    explicit SmallDisk(rlim_t byteCount) : handlerBefore_(std::signal(SIGXFSZ, SIG_IGN))
    {
        getrlimit(RLIMIT_FSIZE, &limitBefore_);
        const rlimit limit = {byteCount, limitBefore_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SmallDisk()
    {
        setrlimit(RLIMIT_FSIZE, &limitBefore_);
        std::signal(SIGXFSZ, handlerBefore_);
    }

private:
    rlimit limitBefore_;
    void (*handlerBefore_)(int);
};

TEST(AtomicFile, HoldsWhatWasWrittenAndNothingElseIsLeftBeside)
{
    const test::TemporaryFolder folder;
    AtomicFile file(folder / "a.bin");
    file.write("hello ");
    file.write("world");
    EXPECT_EQ(file.size(), 11u);
    file.commit();
    EXPECT_EQ(contentOf(folder / "a.bin"), "hello world");
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

TEST(AtomicFile, LeavesTheOldFileUntilCommit)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.bin") << "old";
    AtomicFile file(folder / "a.bin");
    file.write("new");
    EXPECT_EQ(contentOf(folder / "a.bin"), "old");
    file.commit();
    EXPECT_EQ(contentOf(folder / "a.bin"), "new");
}

TEST(AtomicFile, WithoutCommitLeavesNothing)
{
    const test::TemporaryFolder folder;
    {
        AtomicFile file(folder / "a.bin");
        file.write("half a fi");
    }
    EXPECT_EQ(fileCount(folder.path()), 0u);
}

TEST(AtomicFile, OverwritesBytesWhetherPendingOrAlreadyWritten)
{
    const test::TemporaryFolder folder;
    const std::string large(3 << 20, 'x');
    AtomicFile file(folder / "a.bin");
    file.write("head");
    file.write(large);
    file.write("tail");
    file.overwrite(0, "HE", 2);
    file.overwrite(file.size() - 4, "TA", 2);
    file.write("!");
    file.commit();
    EXPECT_EQ(contentOf(folder / "a.bin"), "HEad" + large + "TAil!");
}

TEST(AtomicFile, ManySmallWritesArriveInOrder)
{
    const test::TemporaryFolder folder;
    AtomicFile file(folder / "a.bin");
    std::string expected;
    for (int i = 0; i < 400000; ++i) {
        const std::string piece = std::to_string(i);
        file.write(piece);
        expected += piece;
    }
    file.commit();
    EXPECT_TRUE(contentOf(folder / "a.bin") == expected);
}

TEST(AtomicFile, CannotBeCreatedInAFolderThatDoesNotExist)
{
    const test::TemporaryFolder folder;
    EXPECT_EQ(test::kindThrownBy([&] { AtomicFile file(folder / "missing/a.bin"); }),
              ErrorKind::cannotCreate);
}

TEST(AtomicFile, ReplacesNeitherFoldersNorDevices)
{
    const test::TemporaryFolder folder;
    EXPECT_EQ(test::kindThrownBy([&] { AtomicFile file(folder.path()); }), ErrorKind::cannotCreate);
    EXPECT_EQ(test::kindThrownBy([] { AtomicFile file("/dev/full"); }), ErrorKind::cannotCreate);
}

TEST(AtomicFile, FollowsASymbolicLinkInsteadOfReplacingIt)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "real.bin") << "old";
    fs::create_symlink("real.bin", folder / "link.bin");
    AtomicFile file(folder / "link.bin");
    file.write("new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(folder / "link.bin"));
    EXPECT_EQ(contentOf(folder / "real.bin"), "new");
}

/// A process that is gone: our own child, waited for.
std::string deadProcess()
{
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ::waitpid(gone, nullptr, 0);
    return std::to_string(gone);
}

/// A file that was last written two hours ago.
void leaveOld(const fs::path& path)
{
    std::ofstream(path) << "half";
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(2));
}

// An export that was killed left a hidden file as large as the cache, and each try another.
TEST(AtomicFile, WhatAKilledProcessLeftIsRemovedOnceNobodyCanWriteIt)
{
    const test::TemporaryFolder folder;
    const std::string dead = deadProcess(), alive = std::to_string(::getpid());
    leaveOld(folder / (".x.abc." + dead + "-0.tmp"));
    std::ofstream(folder / (".x.abc." + dead + "-1.tmp")) << "may be another machine's";
    leaveOld(folder / (".x.abc." + alive + "-0.tmp"));
    leaveOld(folder / (".y.abc." + dead + "-0.tmp"));
    leaveOld(folder / (".x.abc." + dead + "-0.tmp.mine"));
    EXPECT_EQ(removeAbandoned(folder / "x.abc"), 1);
    EXPECT_FALSE(fs::exists(folder / (".x.abc." + dead + "-0.tmp")));
    EXPECT_TRUE(fs::exists(folder / (".x.abc." + dead + "-1.tmp")));
    EXPECT_TRUE(fs::exists(folder / (".x.abc." + alive + "-0.tmp")));
    EXPECT_TRUE(fs::exists(folder / (".y.abc." + dead + "-0.tmp")));
    EXPECT_TRUE(fs::exists(folder / (".x.abc." + dead + "-0.tmp.mine")));
}

// Each frame of a sequence has a temporary of its own, and the next run another name for its.
TEST(AtomicFile, WhatKilledRunsLeftOfASequenceIsRemovedToo)
{
    const test::TemporaryFolder folder;
    const std::string dead = "." + deadProcess() + "-0.tmp";
    for (const char* theirs : {"x.1001.png", "x.0007.png", "x.-003.png", "x.10001.png"}) {
        leaveOld(folder / ("." + std::string(theirs) + dead));
    }
    const std::string others[] = {"x.12.png", "x.abcd.png", "x.1001.png.png", "y.1001.png"};
    for (const std::string& other : others) leaveOld(folder / ("." + other + dead));
    EXPECT_EQ(removeAbandoned(folder / "x.####.png"), 4);
    for (const std::string& other : others) {
        EXPECT_TRUE(fs::exists(folder / ("." + other + dead))) << other;
    }
    EXPECT_EQ(removeAbandoned("/no/such/folder/x.####.png"), 0);
}

TEST(AtomicFile, AFullDiskIsAnErrorAndTheOldFileSurvives)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.bin") << "old";
    {
        AtomicFile file(folder / "a.bin");
        const SmallDisk disk(1000);
        file.write(std::string(2000, 'x'));
        EXPECT_EQ(test::kindThrownBy([&] { file.commit(); }), ErrorKind::inputOutput);
    }
    EXPECT_EQ(contentOf(folder / "a.bin"), "old");
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

// The link itself was replaced: what was written stayed on the disk that the link leads away from.
TEST(AtomicFile, FollowsALinkThatLeadsToWhatIsNotThereYet)
{
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "disk");
    fs::create_symlink("disk/second.bin", folder / "first.bin");
    fs::create_symlink("third.bin", folder / "disk/second.bin");
    AtomicFile file(folder / "first.bin");
    file.write("new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(folder / "first.bin"));
    EXPECT_TRUE(fs::is_symlink(folder / "disk/second.bin"));
    EXPECT_EQ(contentOf(folder / "disk/third.bin"), "new");

    fs::create_symlink("round.bin", folder / "round.bin");
    EXPECT_EQ(test::kindThrownBy([&] { AtomicFile{folder / "round.bin"}; }),
              ErrorKind::cannotCreate);
}

}  // namespace
}  // namespace scree
