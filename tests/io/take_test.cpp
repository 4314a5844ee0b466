// Takes: what is written is what is read, and one writes at a time.
#include "io/take.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "io/take_reader.h"
#include "tests/io/take_fixture.h"
#include "tests/support/refusal.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::flipByte;

class TakeTest : public test::TakeFixture {};

TEST_F(TakeTest, ReaderFindsThePosesOfTheAssetsInTheShotsUnit)
{
    writeWholeTake();
    const TakeReader take(folder / "take");
    ASSERT_EQ(take.frames(), (std::vector<int>{1001, 1002, 1003, 1004, 1005}));
    const SceneFrame frame = take.readFrame(1001);
    EXPECT_EQ(frame.frame, 1001);
    // Metres and back costs a few roundings.
    EXPECT_NEAR((frame.worldFromAsset[1].position - Vec3(100, 40, 0)).norm(), 0.0, 1e-10);
    EXPECT_NEAR(frame.velocity[1].x(), 50.0, 1e-10);
}

TEST_F(TakeTest, PlaneIsASquareThatHoldsTheWholeActionAndFacesItsNormal)
{
    writeWholeTake();
    const SceneDescription scene = TakeReader(folder / "take").describe();
    const SceneMesh& plane = scene.meshes[scene.bodies[0].mesh];
    const double half = plane.points.row(0).maxCoeff();
    EXPECT_GT(half, 230.0);  // the block ends at x = 100 cm + 4/3 m
    EXPECT_LT(half, 500.0);
    for (Eigen::Index i = 0; i < plane.triangles.cols(); ++i) {
        const Eigen::Vector3i corner = plane.triangles.col(i);
        const Vec3 a = plane.points.col(corner[0]), b = plane.points.col(corner[1]),
                   c = plane.points.col(corner[2]);
        EXPECT_GT((b - a).cross(c - a).y(), 0.0);
    }
}

TEST_F(TakeTest, ExistingTakeIsNotTouchedWithoutLeave)
{
    writeWholeTake();
    const std::string before = readFileBytes(folder / "take/frames/frame.001005.scree");
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::refuse, shot); }),
              ErrorKind::cannotCreate);
    EXPECT_EQ(readFileBytes(folder / "take/frames/frame.001005.scree"), before);
}

TEST_F(TakeTest, FiguresLeftBehindByARemovedTakeAreNotTheNextOnes)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    fs::remove_all(folder / "take/frames");
    EXPECT_TRUE(open(ExistingTake::refuse, shot).summaries().empty());
}

TEST_F(TakeTest, FiguresThatAreNotFiniteAreKeptAndBreakEveryLimit)
{
    TakeWriter take = open(ExistingTake::refuse, shot);
    FrameStats stats = statsOf(world);
    stats.report.kineticEnergy = std::numeric_limits<double>::infinity();
    stats.report.sum.worstOverlapRatio = std::numeric_limits<double>::quiet_NaN();
    take.writeFrame(world, stats);
    ASSERT_EQ(take.summaries().size(), 1u);
    EXPECT_TRUE(std::isinf(take.summaries()[0].kineticEnergy));
    EXPECT_GT(take.summaries()[0].overlapRatio, 1e300);
}

TEST_F(TakeTest, DamagedMeshIsNoticedByItsHash)
{
    writeWholeTake();
    const fs::path mesh = folder / "take/shapes/block.ply";
    flipByte(mesh, readFileBytes(mesh).size() - 1);
    EXPECT_EQ(test::kindThrownBy([&] { TakeReader(folder / "take").describe(); }),
              ErrorKind::inputOutput);
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 1u);
    EXPECT_NO_THROW(TakeReader(folder / "take").describe());
}

// A line that the disk would not keep was taken for written.
TEST_F(TakeTest, FiguresThatCannotBeMadeDurableAreAnError)
{
    TakeWriter take = open(ExistingTake::refuse, shot);
    fs::remove(folder / "take/stats.jsonl");
    fs::create_symlink("/dev/null", folder / "take/stats.jsonl");  // takes all, syncs nothing
    EXPECT_EQ(test::kindThrownBy([&] { take.writeFrame(world, statsOf(world)); }),
              ErrorKind::inputOutput);
}

TEST_F(TakeTest, SecondWriterIsKeptOut)
{
    const TakeWriter take = open(ExistingTake::refuse, shot);
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }),
              ErrorKind::cannotCreate);
}

TEST_F(TakeTest, ADamagedFrameKeepsNobodyFromTheOthers)
{
    writeWholeTake();
    flipByte(folder / "take/frames/frame.001003.scree", 200);
    const TakeReader take(folder / "take");
    std::vector<int> seen;
    take.forWholeFrames(take.frames(),
                        [&](int frame, const SceneFrame&) { seen.push_back(frame); });
    EXPECT_EQ(seen, (std::vector{1001, 1002, 1004, 1005}));
}

// A lock on the folder itself other machines are not told of.
TEST_F(TakeTest, AWriterIsKeptOutByALockOnTheLockFile)
{
    writeWholeTake();
    const int descriptor = ::open((folder / "take/.lock").c_str(), O_RDWR);
    ASSERT_GE(descriptor, 0);
    struct flock whole = {};
    whole.l_type = F_WRLCK;
    ASSERT_EQ(::fcntl(descriptor, F_OFD_SETLK, &whole), 0);
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }),
              ErrorKind::cannotCreate);
    ::close(descriptor);
    EXPECT_NO_THROW(open(ExistingTake::resume, shot));
}

}  // namespace
}  // namespace scree
