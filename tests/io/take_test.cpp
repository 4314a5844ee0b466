// Frame files and takes: what is written is what is read, damage is seen, gaps are found.
#include "io/take.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/diagnostics/state_hash.h"
#include "core/picture/camera_motion.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/shot_parser.h"
#include "io/take_reader.h"
#include "io/world_state.h"
#include "tests/support/refusal.h"
#include "tests/support/small_gltf.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// A block above the ground and a camera; the ground is body 0.
std::string shotText()
{
    const test::SmallShot shot{
        .name = "two", .frames = "1001-1005", .shotKeys = "units = \"cm\"", .box = "[10, 20, 30]"};
    const std::string block = test::bodyText("block",
                                             "position = [100, 40, 0]\n"
                                             "rotation = [10, 20, 30]\n"
                                             "velocity = [50, 0, 0]");
    return shotTextOf(shot, block +
                                "[[camera]]\nname = \"main\"\neye = [300, 200, 100]\n"
                                "target = [0, 10, 0]\n");
}

/// A shot, its world, and a stand-in for simulation that is quick and reaches every value.
class TakeTest : public testing::Test {
protected:
    TakeTest() : shot(parseShotText(shotText(), "two.toml")), world(buildWorld(shot)) {}

    void advance(World& moved) const
    {
        ++moved.clock.frame;
        moved.motion[1].position.x() += 1.0 / 3.0;
        moved.motion[1].angularMomentum.z() -= 0.1;
        std::swap(moved.order[0], moved.order[1]);
    }

    FrameStats statsOf(const World& moved) const
    {
        FrameStats stats;
        stats.frame = shot.firstFrame + static_cast<int>(moved.clock.frame);
        stats.report.stateHash = stateHash(moved);
        return stats;
    }

    TakeWriter open(ExistingTake existing, const Shot& used)
    {
        return TakeWriter(folder / "take", used, world, "1.2.3", existing);
    }

    /// All five frames.
    void writeWholeTake()
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        World moved = world;
        take.writeFrame(moved, statsOf(moved));
        for (int i = 0; i < 4; ++i) {
            advance(moved);
            take.writeFrame(moved, statsOf(moved));
        }
    }

    TemporaryFolder folder;
    Shot shot;
    World world;
};

void flipByte(const fs::path& path, std::size_t offset)
{
    std::string bytes = readFileBytes(path);
    bytes[offset] ^= 1;
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(TakeTest, RestoringAStateGivesBackEveryBit)
{
    World moved = world;
    advance(moved);
    moved.clock.subStep = 7;
    moved.clock.frameTimeDone = 0.1;
    moved.contactMemory.dt = 0.01;
    moved.contactMemory.contacts = {
        {0, 1, 7, Vec3(0.1, 0.2, 0.3), Vec3(1.0, 9.0, 2.0), Vec3(0.0, 0.5, 0.0)}};
    const std::string bytes = encodeFrame(captureState(shot, moved));

    World restored = buildWorld(shot);
    restoreState(restored, decodeFrame(bytes, "memory"));

    EXPECT_EQ(stateHash(restored), stateHash(moved));
    EXPECT_EQ(restored.clock.frameTimeDone, 0.1);
    EXPECT_EQ(encodeFrame(captureState(shot, restored)), bytes);
}

TEST_F(TakeTest, EverySingleFlippedByteOfAFrameIsNoticed)
{
    const std::string bytes = encodeFrame(captureState(shot, world));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string damaged = bytes;
        damaged[i] ^= 0x10;
        EXPECT_THROW(decodeFrame(damaged, "memory"), Error) << "byte " << i;
    }
}

TEST_F(TakeTest, EveryCutOfAFrameIsNoticed)
{
    const std::string bytes = encodeFrame(captureState(shot, world));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decodeFrame(bytes.substr(0, size), "memory"), Error) << size << " bytes";
}

TEST_F(TakeTest, AStateThatNoStepCouldGoOnFromIsRefusedThoughItsChecksumFits)
{
    const FrameState good = captureState(shot, world);
    const auto expectRefusal = [&](const std::string& reason, const auto& spoil) {
        FrameState state = good;
        spoil(state);
        const test::Refusal refusal =
            test::refusalBy([&] { decodeFrame(encodeFrame(state), "memory"); });
        EXPECT_TRUE(refusal.mentions(reason)) << refusal.message;
    };
    const auto remember = [](FrameState& state,
                             std::initializer_list<std::pair<BodyId, BodyId>> pairs) {
        state.contactMemory.dt = 0.01;
        for (const auto& [a, b] : pairs)
            state.contactMemory.contacts.push_back(
                {a, b, 0, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    };
    EXPECT_NO_THROW(decodeFrame(encodeFrame(good), "memory"));
    for (const BodyId wrong : {2000000000, -1, good.order[0]})
        expectRefusal("order of bodies", [&](FrameState& s) { s.order[1] = wrong; });
    expectRefusal("clock", [](FrameState& s) { s.clock.subStep = -1; });
    expectRefusal("clock", [](FrameState& s) { s.clock.frameTimeDone = NAN; });
    expectRefusal("clock", [](FrameState& s) { s.clock.frameTimeDone = -0.01; });
    expectRefusal("body 1", [](FrameState& s) { s.motion[1].velocity.y() = INFINITY; });
    expectRefusal("does not exist", [&](FrameState& s) { remember(s, {{0, 2}}); });
    expectRefusal("not in order", [&](FrameState& s) { remember(s, {{1, 1}, {0, 1}}); });
}

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

TEST_F(TakeTest, DescriptionOfTheTakeIsTheOneOfTheShot)
{
    writeWholeTake();
    const SceneDescription expected = describeScene(shot, world, 1.0);
    const SceneDescription scene = TakeReader(folder / "take").describe();
    ASSERT_EQ(scene.bodies.size(), expected.bodies.size());
    EXPECT_EQ(scene.name, expected.name);
    EXPECT_EQ(scene.metresPerUnit, expected.metresPerUnit);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const SceneBody &body = scene.bodies[i], &other = expected.bodies[i];
        EXPECT_EQ(body.name, other.name);
        EXPECT_EQ(body.material, other.material);
        EXPECT_EQ(body.mass, other.mass);
        EXPECT_EQ(body.moves, other.moves);
        const SceneMesh& mesh = scene.meshes[body.mesh];
        EXPECT_EQ(mesh.name, expected.meshes[other.mesh].name);
        EXPECT_EQ(mesh.triangles.cols(), expected.meshes[other.mesh].triangles.cols());
    }
    const SceneMesh& block = scene.meshes[scene.bodies[1].mesh];
    EXPECT_EQ(block.points, expected.meshes[expected.bodies[1].mesh].points);
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

TEST_F(TakeTest, TakeInfoSurvivesItsText)
{
    const SceneDescription scene = describeScene(shot, world, 1.0);
    const TakeInfo info = makeTakeInfo(shot, world, scene, "1.2.3");
    const std::string text = encodeTakeInfo(info);
    const TakeInfo back = decodeTakeInfo(text, "take.json");
    EXPECT_EQ(encodeTakeInfo(back), text);
    EXPECT_EQ(back.cameras.at(0).eye, info.cameras.at(0).eye);
    EXPECT_NEAR(back.cameras.at(0).eye.x(), 300.0, 1e-10);
    EXPECT_EQ(back.resolvedShot, shot.resolvedText);
}

TEST_F(TakeTest, WhatNoShotCouldHaveSaidIsRefusedByItsKey)
{
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    const nlohmann::json good = nlohmann::json::parse(encodeTakeInfo(info));
    const auto expectRefusal = [&](const std::string& pointer, const nlohmann::json& value) {
        nlohmann::json json = good;
        json.at(nlohmann::json::json_pointer(pointer)) = value;
        const test::Refusal refusal =
            test::refusalBy([&] { decodeTakeInfo(json.dump(), "take.json"); });
        EXPECT_EQ(refusal.kind, ErrorKind::inputOutput);
        const std::string& message = refusal.message;
        EXPECT_TRUE(message.starts_with("take.json: damaged: \"")) << message;
        EXPECT_NE(message.find(value.dump()), std::string::npos) << message;
    };
    EXPECT_NO_THROW(decodeTakeInfo(good.dump(), "take.json"));
    expectRefusal("/picture_size/0", 0);
    expectRefusal("/picture_size/1", 4294967296.0 + 720.0);  // once 720
    expectRefusal("/picture_size/1", 720.5);
    expectRefusal("/motion_blur", 0);
    expectRefusal("/fps", 0.0);
    expectRefusal("/fps", -24.0);
    expectRefusal("/frames/0", 1006);
    expectRefusal("/frames/1", 1e300);
    expectRefusal("/metres_per_unit", 0.0);
    expectRefusal("/up", "+x");
    expectRefusal("/name", "../../elsewhere");
    expectRefusal("/name", "");
    expectRefusal("/cameras/0/fov", 180.0);
    expectRefusal("/bodies/1/motion", "dynamik");
    expectRefusal("/bodies/1/mass", -1.0);
    expectRefusal("/looks/0/color/2", 1.5);
    expectRefusal("/looks/0/roughness", -0.5);
}

TEST_F(TakeTest, CamerasThatMoveSurviveTheTextOfTheTake)
{
    SceneCamera keyed, orbiting;
    keyed.keys = {{1001.0, {1.0, 2.0, 3.0}, {0.0, 0.1, 0.0}, 30.0},
                  {1003.5, {4.0, 2.0, 3.0}, {0.0, 0.2, 0.0}, 40.0}};
    keyed.isSmooth = false;
    orbiting.orbit = CameraOrbit{{0.1, 0.2, 0.3}, 5.0, 2.0, 30.0, -90.0, 1001.0, 1004.0};
    shot.cameras = {keyed, orbiting};
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    const TakeInfo back = decodeTakeInfo(encodeTakeInfo(info), "take.json");
    ASSERT_EQ(back.cameras.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
        // The shot is in centimetres, the cameras above are in metres.
        const Vec3 eye = 100.0 * cameraAt(shot.cameras[k], 1002.3, false).eye;
        EXPECT_LT((cameraAt(back.cameras[k], 1002.3, false).eye - eye).norm(), 1e-9) << k;
    }
    EXPECT_FALSE(back.cameras[0].isSmooth);
}

TEST_F(TakeTest, WhatTheLastStepDidIsKeptAndIsNoPartOfTheState)
{
    StepSeen step;
    step.dt = 1.0 / 96.0;
    step.level = {0, 1};
    step.overlap = {1e-5, 1e-5};
    step.contacts = {{0, 1, {0.1, 0.2, 0.3}, {0.0, -1.0, 0.0}, {0.5, -4.0, 0.25}},
                     {0, 1, {0.4, 0.2, 0.3}, {0.0, -1.0, 0.0}, {0.0, -3.0, 0.0}}};
    FrameState state = captureState(shot, world);
    const std::string without = encodeFrame(state);
    state.lastStep = step;
    const FrameState back = decodeFrame(encodeFrame(state), "memory");
    ASSERT_TRUE(back.lastStep);
    EXPECT_EQ(back.lastStep->dt, step.dt);
    EXPECT_EQ(back.lastStep->level, step.level);
    EXPECT_EQ(back.lastStep->overlap, step.overlap);
    ASSERT_EQ(back.lastStep->contacts.size(), 2U);
    EXPECT_EQ(back.lastStep->contacts[1].point, step.contacts[1].point);
    EXPECT_EQ(back.lastStep->contacts[0].normal, step.contacts[0].normal);
    EXPECT_EQ(back.lastStep->contacts[0].impulse, step.contacts[0].impulse);

    World restored = buildWorld(shot);
    restoreState(restored, back);
    EXPECT_EQ(encodeFrame(captureState(shot, restored)), without);
    state.lastStep->contacts[0].b = 2;  // there are two bodies
    EXPECT_THROW(decodeFrame(encodeFrame(state), "memory"), Error);
}

TEST_F(TakeTest, ChangedShotTextInTakeJsonIsNoticed)
{
    const SceneDescription scene = describeScene(shot, world, 1.0);
    std::string text = encodeTakeInfo(makeTakeInfo(shot, world, scene, "1.2.3"));
    text.replace(text.find("density = 650"), 13, "density = 651");
    EXPECT_EQ(test::kindThrownBy([&] { decodeTakeInfo(text, "take.json"); }),
              ErrorKind::inputOutput);
}

TEST_F(TakeTest, ExistingTakeIsNotTouchedWithoutLeave)
{
    writeWholeTake();
    const std::string before = readFileBytes(folder / "take/frames/frame.001005.scree");
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::refuse, shot); }),
              ErrorKind::cannotCreate);
    EXPECT_EQ(readFileBytes(folder / "take/frames/frame.001005.scree"), before);
}

TEST_F(TakeTest, OverwritingLeavesNothingOfTheOldTake)
{
    writeWholeTake();
    const TakeWriter take = open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(take.hasFrame(1001));
    EXPECT_FALSE(fs::exists(take.paths().frame(1003)));
    EXPECT_FALSE(fs::exists(take.paths().stats()));
}

TEST_F(TakeTest, OverwritingTakesPicturesAndCachesOfTheOldTakeWithIt)
{
    // In a folder that holds no take they are somebody else's.
    for (const char* name : {"images", "exports"}) fs::create_directories(folder / "take" / name);
    writeFileBytes(folder / "take/images/holiday.png", "mine");
    EXPECT_THROW(open(ExistingTake::overwrite, shot), Error);
    EXPECT_TRUE(fs::exists(folder / "take/images/holiday.png"));
    fs::remove(folder / "take/images/holiday.png");

    open(ExistingTake::overwrite, shot);
    writeFileBytes(folder / "take/images/ours.png", "made from it");
    writeFileBytes(folder / "take/exports/old.abc", "old");
    open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(fs::exists(folder / "take/images"));
    EXPECT_FALSE(fs::exists(folder / "take/exports"));
}

TEST_F(TakeTest, ShapesThatAreNotThereAreWrittenOnResume)
{
    writeWholeTake();
    fs::remove_all(TakePaths{folder / "take"}.shapes());
    open(ExistingTake::resume, shot);
    EXPECT_NO_THROW(TakeReader(folder / "take").describe());
}

TEST_F(TakeTest, FiguresLeftBehindByARemovedTakeAreNotTheNextOnes)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    fs::remove_all(folder / "take/frames");
    EXPECT_TRUE(open(ExistingTake::refuse, shot).summaries().empty());
}

TEST_F(TakeTest, FramesWithoutFiguresAreTold)
{
    writeWholeTake();
    EXPECT_TRUE(open(ExistingTake::resume, shot).notices().empty());
    fs::remove(folder / "take/stats.jsonl");
    const TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_NE(take.notices()[0].find("no figures for 5 frames"), std::string::npos)
        << take.notices()[0];
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

TEST_F(TakeTest, ResumeRefusesAnotherShot)
{
    writeWholeTake();
    const Shot other = parseShotText(shotText(), "two.toml", {"material.wood.friction=0.9"});
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, other); }), ErrorKind::badInput);
}

TEST_F(TakeTest, ResumeRefusesAWorldThatBeginsElsewhere)
{
    writeWholeTake();
    world.motion[1].position.x() += 1e-12;
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }), ErrorKind::badInput);
}

TEST_F(TakeTest, LostOrCutTakeJsonIsMadeAgainFromFramesOfTheShot)
{
    writeWholeTake();
    const std::string whole = readFileBytes(folder / "take/take.json");
    for (const bool isCut : {false, true}) {
        fs::remove(folder / "take/take.json");
        if (isCut) writeFileBytes(folder / "take/take.json", whole.substr(0, 20));
        EXPECT_NE(test::kindThrownBy([&] { TakeReader(folder / "take"); }), std::nullopt);
        const TakeWriter take = open(ExistingTake::resume, shot);
        EXPECT_EQ(take.notices().size(), 1u);
        EXPECT_TRUE(take.hasFrame(1005));
        EXPECT_EQ(readFileBytes(folder / "take/take.json"), whole);
    }
}

TEST_F(TakeTest, LostTakeJsonIsAnErrorBesideFramesOfAnotherShotOrWithAGap)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    const Shot other = parseShotText(shotText(), "two.toml", {"material.wood.friction=0.9"});
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, other); }), ErrorKind::badInput);
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::refuse, shot); }),
              ErrorKind::inputOutput);
    fs::remove(folder / "take/frames/frame.001003.scree");
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }),
              ErrorKind::inputOutput);
    EXPECT_EQ(listFrames({folder / "take"}).size(), 4u);
}

TEST_F(TakeTest, OverwritingLeavesWhatIsSomebodyElses)
{
    writeWholeTake();
    const std::array mine = {folder / "take/frames/beauty.1001.exr",
                             folder / "take/shapes/hero.ply"};
    for (const fs::path& file : mine) writeFileBytes(file, "mine");
    open(ExistingTake::overwrite, shot);
    for (const fs::path& file : mine) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(TakeTest, AFolderWithADescriptionOrStatisticsOfSomethingElseIsRefused)
{
    fs::create_directories(folder / "take/images");
    for (const char* name : {"take.json", "stats.jsonl"}) {
        const fs::path file = folder / "take" / name;
        writeFileBytes(file, "{\"foo\": 1}\n");
        for (const auto existing :
             {ExistingTake::refuse, ExistingTake::resume, ExistingTake::overwrite}) {
            EXPECT_EQ(test::kindThrownBy([&] { open(existing, shot); }), ErrorKind::cannotCreate);
        }
        EXPECT_TRUE(fs::exists(folder / "take/images"));
        fs::remove(file);
    }
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

// A folder of shapes was there before: a name was taken for the mesh.
TEST_F(TakeTest, AMeshOfAnotherTakeIsNotTakenForTheShots)
{
    fs::create_directories(folder / "take/shapes");
    writeFileBytes(folder / "take/shapes/block.ply", "ply");
    open(ExistingTake::refuse, shot);
    EXPECT_NO_THROW(TakeReader(folder / "take").describe());
}

TEST_F(TakeTest, DamagedFrameIsReportedAndOpenAgainWhileOthersStay)
{
    writeWholeTake();
    flipByte(folder / "take/frames/frame.001003.scree", 300);
    TakeWriter take = open(ExistingTake::resume, shot);
    ASSERT_EQ(take.notices().size(), 1u);
    EXPECT_NE(take.notices()[0].find("frame.001003.scree"), std::string::npos);
    EXPECT_FALSE(take.hasFrame(1003));
    EXPECT_TRUE(take.hasFrame(1005));

    // Filling the hole gives the statistics their order back.
    World moved = world;
    take.prepareFor(1003, moved);
    EXPECT_EQ(moved.clock.frame, 1);
    advance(moved);
    take.writeFrame(moved, statsOf(moved));
    std::vector<int> frames;
    for (const FrameSummary& line : take.summaries()) frames.push_back(line.frame);
    EXPECT_EQ(frames, (std::vector<int>{1001, 1002, 1003, 1004, 1005}));
}

TEST_F(TakeTest, CheckpointIsWhereAFrameGoesOnAndGoesWithIt)
{
    World moved = world;
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        take.writeFrame(moved, statsOf(moved));
        moved.clock.subStep = 3;
        moved.motion[1].position.y() -= 0.25;
        take.writeCheckpoint(moved);
    }
    TakeWriter take = open(ExistingTake::resume, shot);
    World resumed = world;
    take.prepareFor(1002, resumed);
    EXPECT_EQ(stateHash(resumed), stateHash(moved));
    resumed.clock = {1, 0, 0.0};
    take.writeFrame(resumed, statsOf(resumed));
    EXPECT_FALSE(fs::exists(take.paths().checkpoint()));
}

TEST_F(TakeTest, DamagedCheckpointFallsBackToTheFrame)
{
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        World moved = world;
        take.writeFrame(moved, statsOf(moved));
        moved.clock.subStep = 3;
        take.writeCheckpoint(moved);
    }
    flipByte(folder / "take/checkpoint.scree", 200);
    const TakeWriter take = open(ExistingTake::resume, shot);
    EXPECT_EQ(take.notices().size(), 1u);
    World resumed = world;
    take.prepareFor(1002, resumed);
    EXPECT_EQ(stateHash(resumed), stateHash(world));
}

// It stayed for ever, and every later resume told of it again.
TEST_F(TakeTest, DamagedCheckpointIsToldOnceAndRemoved)
{
    writeWholeTake();
    writeFileBytes(folder / "take/checkpoint.scree", "garbage");
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 1u);
    EXPECT_FALSE(fs::exists(folder / "take/checkpoint.scree"));
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 0u);
}

// Frames of two bodies were then of another take for every reader.
TEST_F(TakeTest, ATakeJsonThatLostItsBodiesIsPutRightOnResume)
{
    writeWholeTake();
    const fs::path path = folder / "take/take.json";
    const std::string whole = readFileBytes(path);
    TakeInfo info = decodeTakeInfo(whole, path);
    info.bodies.clear();
    writeFileBytes(path, encodeTakeInfo(info));
    EXPECT_EQ(TakeReader(folder / "take").damagedFrames().size(), 5u);
    EXPECT_EQ(open(ExistingTake::resume, shot).notices().size(), 1u);
    EXPECT_EQ(readFileBytes(path), whole);
    EXPECT_TRUE(TakeReader(folder / "take").damagedFrames().empty());
}

TEST_F(TakeTest, CutLineOfTheStatisticsIsDroppedOnResume)
{
    writeWholeTake();
    std::ofstream(folder / "take/stats.jsonl", std::ios::app) << R"({"frame":1006,"wall_s":0.)";
    const TakeWriter take = open(ExistingTake::resume, shot);
    const std::string text = readFileBytes(take.paths().stats());
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
    EXPECT_TRUE(text.ends_with("}\n"));
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

TEST_F(TakeTest, TemporariesOfAKilledWriterAreRemovedAndNoOthers)
{
    writeWholeTake();
    const pid_t killed = ::fork();
    if (killed == 0) ::_exit(0);
    ::waitpid(killed, nullptr, 0);
    const std::string gone = "." + std::to_string(killed) + "-2.tmp";
    const std::array ours = {folder / ("take/frames/.frame.001006.scree" + gone),
                             folder / ("take/shapes/.block.ply" + gone),
                             folder / ("take/.take.json" + gone)};
    // A film that is being made there, what somebody else calls so, and what another machine may be
    // writing, where locks are not passed on.
    const std::array others = {folder / ("take/.film.mp4" + gone), folder / "take/frames/.x.tmp",
                               folder / ("take/frames/.frame.001007.scree" + gone)};
    const auto longAgo = fs::file_time_type::clock::now() - std::chrono::hours(2);
    for (const fs::path& file : ours) writeFileBytes(file, "half");
    for (const fs::path& file : others) writeFileBytes(file, "half");
    for (const fs::path& file : ours) fs::last_write_time(file, longAgo);
    open(ExistingTake::resume, shot);
    for (const fs::path& file : ours) EXPECT_FALSE(fs::exists(file)) << file;
    for (const fs::path& file : others) EXPECT_TRUE(fs::exists(file)) << file;
}

// The line is written before the frame; cut, it was taken for statistics of something else.
TEST_F(TakeTest, ATakeOfOneCutLineIsGoneOnWith)
{
    open(ExistingTake::refuse, shot);
    writeFileBytes(folder / "take/stats.jsonl", "{\"frame\":10");
    EXPECT_NO_THROW(open(ExistingTake::resume, shot));
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

// It had replaced the meshes, and taken their hashes into take.json, before it saw that the shot is
// another: what was there fitted its frames no more.
TEST_F(TakeTest, AResumeThatIsRefusedHasWrittenNothing)
{
    writeWholeTake();
    const TakePaths paths{folder / "take"};
    TakeInfo info = decodeTakeInfo(readFileBytes(paths.info()), paths.info());
    const std::string asItWas = encodeTakeInfo(info);
    info.shapes.at(0).hash ^= 1;
    const std::string ofOtherMesh = encodeTakeInfo(info);
    for (const std::string& text : {asItWas, ofOtherMesh}) {
        writeFileBytes(paths.info(), text);
        writeFileBytes(paths.shape("block"), "an older mesh");
        World changed = world;
        if (text == asItWas) changed.motion[1].position.x() += 1e-12;
        EXPECT_EQ(test::kindThrownBy([&] {
                      TakeWriter(folder / "take", shot, changed, "1.2.3", ExistingTake::resume);
                  }),
                  ErrorKind::badInput);
        EXPECT_EQ(readFileBytes(paths.info()), text);
        EXPECT_EQ(readFileBytes(paths.shape("block")), "an older mesh");
    }
}

TEST_F(TakeTest, ALostTakeJsonIsNotMadeAgainForAWorldThatBeginsElsewhere)
{
    writeWholeTake();
    fs::remove(folder / "take/take.json");
    world.motion[1].position.x() += 1e-12;
    EXPECT_EQ(test::kindThrownBy([&] { open(ExistingTake::resume, shot); }), ErrorKind::badInput);
    EXPECT_FALSE(fs::exists(folder / "take/take.json"));
}

// What a look at all poses had found was forgotten between two sittings, and so were the figures of
// the steps before a stop: whether a limit was broken depended on where a run was interrupted.
TEST_F(TakeTest, ACheckpointKeepsFiguresAndOverlapsThatContactsDoNotTellOf)
{
    World moved = world;
    FrameReport soFar;
    soFar.steps = 3;
    soFar.shortestStep = 1e-3;
    soFar.substepCapReached = true;
    soFar.fastestBody = 1;
    soFar.sum.limitedBy = StepLimit::hover;
    soFar.sum.contactImpulses.rolling = 7;
    soFar.sum.worstOverlapRatio = 0.125;
    soFar.sum.worstA = 0;
    soFar.sum.worstB = 1;
    {
        TakeWriter take = open(ExistingTake::refuse, shot);
        take.writeFrame(moved, statsOf(moved), {}, {}, {{0, 1}});
        moved.clock.subStep = 3;
        take.writeCheckpoint(moved, {}, soFar, {{0, 1}});
    }
    const TakeWriter take = open(ExistingTake::resume, shot);
    EXPECT_TRUE(take.notices().empty()) << take.notices().front();
    World resumed = world;
    const std::optional<FrameState> left = take.prepareFor(1002, resumed);
    ASSERT_TRUE(left);
    EXPECT_EQ(left->untold, (std::vector<BodyPair>{{0, 1}}));
    EXPECT_EQ(left->soFar.steps, 3);
    EXPECT_EQ(left->soFar.shortestStep, 1e-3);
    EXPECT_TRUE(left->soFar.substepCapReached);
    EXPECT_EQ(left->soFar.fastestBody, 1);
    EXPECT_EQ(left->soFar.sum.limitedBy, StepLimit::hover);
    EXPECT_EQ(left->soFar.sum.contactImpulses.rolling, 7);
    EXPECT_EQ(left->soFar.sum.worstOverlapRatio, 0.125);
    EXPECT_EQ(left->soFar.sum.worstB, 1);
    EXPECT_EQ(readFrameFile(take.paths().frame(1001)).untold, (std::vector<BodyPair>{{0, 1}}));
}

// Of a take whose take.json was lost, old pictures and caches stayed beside the new frames.
TEST_F(TakeTest, OverwritingATakeWithoutTakeJsonTakesPicturesAndCachesWithItToo)
{
    writeWholeTake();
    for (const char* name : {"images", "exports"}) fs::create_directories(folder / "take" / name);
    writeFileBytes(folder / "take/images/two.1001.png", "old");
    writeFileBytes(folder / "take/exports/two.abc", "old");
    fs::remove(folder / "take/take.json");
    open(ExistingTake::overwrite, shot);
    EXPECT_FALSE(fs::exists(folder / "take/images"));
    EXPECT_FALSE(fs::exists(folder / "take/exports"));
}

// Frames went back to the small disk that the link was to spare.
TEST_F(TakeTest, OverwritingLeavesFoldersThatAreLinksWhereTheyLead)
{
    for (const char* name : {"frames", "shapes", "images"}) {
        fs::create_directories(folder / "disk" / name);
        fs::create_directories(folder / "take");
        fs::create_directory_symlink(folder / "disk" / name, folder / "take" / name);
    }
    writeWholeTake();
    writeFileBytes(folder / "disk/images/two.1001.png", "old");
    const TakeWriter take = open(ExistingTake::overwrite, shot);
    for (const char* name : {"frames", "shapes", "images"})
        EXPECT_TRUE(fs::is_symlink(folder / "take" / name)) << name;
    EXPECT_TRUE(listFrames(take.paths()).empty());
    EXPECT_TRUE(fs::exists(folder / "disk/shapes/block.ply"));
    EXPECT_FALSE(fs::exists(folder / "disk/images/two.1001.png"));
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

// A camera, a pile of poses and the bytes of a glTF could change under a take.
TEST(TakeInputs, AreAllTheFilesThatAShotIsReadFrom)
{
    const TemporaryFolder folder;
    test::writeGltf(folder);
    fs::copy_file(folder / "set.gltf", folder / "cam.gltf");
    std::string camera = readFileBytes(folder / "cam.gltf");
    camera.replace(camera.find("\"mesh\":0}]"), 10, "\"camera\":0}]");
    camera.insert(camera.rfind('}'),
                  R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}])");
    writeFileBytes(folder / "cam.gltf", camera);
    for (const char* name : {"a.poses", "b.poses"})
        writeFileBytes(folder / name, "0 5 0 1 0 0 0\n");
    const std::string text =
        test::shotTextOf({}, test::bodyText("pile", "poses = \"a.poses\"") +
                                 "[[emitter]]\nname = \"rain\"\nshape = \"block\"\nmaterial = "
                                 "\"wood\"\ncount = 1\nposes = \"b.poses\"\n[[camera]]\nfile = "
                                 "\"cam.gltf\"\n[[import]]\nfile = \"set.gltf\"\nmaterial = "
                                 "\"wood\"\nmotion = \"static\"\n");
    writeFileBytes(folder / "s.toml", text);
    const Shot shot = parseShot(folder / "s.toml", {});
    const World world = buildWorld(shot);
    const TakeInfo info = makeTakeInfo(shot, world, describeScene(shot, world, 1.0), "1.2.3");
    std::vector<std::string> names;
    for (const TakeInput& input : info.inputs) names.push_back(fs::path(input.path).filename());
    EXPECT_EQ(names,
              (std::vector<std::string>{"set.gltf", "a.poses", "b.poses", "cam.gltf", "data.bin"}));
}

}  // namespace
}  // namespace scree
