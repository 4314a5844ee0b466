// Variants that go on from a frame of another take, and where two takes part.
#include "io/take_branch.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "core/base/error.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/frame_file.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_diff.h"
#include "io/take_reader.h"
#include "tests/support/refusal.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// A block that falls on the ground in its third frame and slides.
const std::string kShotText =
    test::shotTextOf({.name = "slide", .frames = "1001-1009", .box = "[0.4, 0.2, 0.4]"},
                     test::bodyText("block", "position = [0, 0.13, 0]\nvelocity = [2, 0, 0]") +
                         test::bodyText("away", "position = [0, 50, 0]") +
                         test::bodyText("pusher",
                                        "motion = \"keyed\"\ninterpolate = \"linear\"\n"
                                        "keys = [{ frame = 1003, position = [9, 1, 0] }, "
                                        "{ frame = 1009, position = [9, 4, 0] }]"));

class BranchTest : public testing::Test {
protected:
    /// Simulates into a take, from time zero or from a branch, and reads it.
    TakeReader simulate(const std::string& name, const std::vector<std::string>& overrides,
                        const std::optional<TakeBranch>& branch = std::nullopt,
                        ExistingTake existing = ExistingTake::refuse)
    {
        writeFileBytes(folder / "slide.toml", kShotText);
        const Shot shot = parseShot((folder / "slide.toml").string(), overrides);
        World world = buildWorld(shot);
        TakeWriter take(folder / name, shot, world, "1.2.3", existing, branch);
        notices = take.notices();
        Stepper stepper(shot.settings);
        for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
            if (take.hasFrame(frame)) continue;
            FrameStats stats;
            stats.frame = frame;
            if (frame > shot.firstFrame) {
                take.prepareFor(frame, world);
                stats.report = stepper.advanceFrame(world, 1.0 / shot.framesPerSecond);
            }
            take.writeFrame(world, stats);
        }
        return TakeReader(folder / name);
    }

    /// Why it is not done; no file named `name` may come, go or change by that.
    std::string refusalOf(const std::vector<std::string>& overrides, const TakeBranch& branch,
                          const std::string& name = "refused",
                          ExistingTake existing = ExistingTake::refuse)
    {
        const std::map<std::string, std::string> before = filesOf(name);
        const test::Refusal refusal =
            test::refusalBy([&] { simulate(name, overrides, branch, existing); });
        EXPECT_EQ(filesOf(name), before);
        return refusal.message;
    }

    /// All files of a take by their names inside it, with their bytes.
    std::map<std::string, std::string> filesOf(const std::string& name) const
    {
        std::map<std::string, std::string> files;
        if (!fs::exists(folder / name)) return files;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder / name)) {
            if (entry.is_regular_file()) files[entry.path()] = readFileBytes(entry.path());
        }
        return files;
    }

    /// Copies a take but for the files the predicate names.
    void copyWithout(const std::string& from, const std::string& to,
                     const std::function<bool(const fs::path&)>& isMissing) const
    {
        fs::remove_all(folder / to);
        fs::copy(folder / from, folder / to, fs::copy_options::recursive);
        std::vector<fs::path> doomed;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder / to)) {
            if (entry.is_regular_file() && isMissing(entry.path())) doomed.push_back(entry.path());
        }
        for (const fs::path& path : doomed) fs::remove(path);
    }

    test::TemporaryFolder folder;
    std::vector<std::string> notices;  // of the last take
};

TEST_F(BranchTest, ABranchWithTheSameSettingsGivesTheSameBits)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader branch = simulate("branch", {}, TakeBranch{folder / "whole", 1005});
    EXPECT_TRUE(compareTakes(whole, branch).isSame());
    EXPECT_EQ(readFileBytes(whole.paths().frame(1009)), readFileBytes(branch.paths().frame(1009)));
    EXPECT_EQ(branch.info().branchFrame, 1005);
    EXPECT_EQ(branch.stats().size(), 9u);
}

TEST_F(BranchTest, AVariantPartsFromItsOriginalAfterTheBranchAndOnlyInWhatItChanges)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader slippery =
        simulate("slippery", {"material.wood.friction=0.0"}, TakeBranch{folder / "whole", 1005});
    const TakeComparison comparison = compareTakes(whole, slippery);
    ASSERT_TRUE(comparison.difference);
    EXPECT_EQ(comparison.difference->frame, 1006);
    EXPECT_EQ(comparison.difference->bodies, std::vector<std::string>{"block"});
    EXPECT_EQ(comparison.difference->farthestBody, "block");
    EXPECT_GT(comparison.difference->farthest, 1e-4);
    EXPECT_GT(comparison.difference->stepsA, 0);
    EXPECT_EQ(comparison.framesCompared, 6);
}

// A block slept on a slope, and when its friction was taken from it, it slept on.
// Another camera or colour meant to simulate the whole shot again.
TEST_F(BranchTest, OfTheLastFrameIsTheWholeTakeWithOtherLooks)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader painted =
        simulate("painted", {"material.wood.color=[1, 0, 0]"}, TakeBranch{folder / "whole", 1009});
    EXPECT_FALSE(compareTakes(whole, painted).difference);
    EXPECT_EQ(painted.frames().size(), 9u);
    EXPECT_EQ(painted.info().materials.at(0).color, Vec3(1, 0, 0));
    EXPECT_EQ(painted.stats().size(), 9u);
}

// A pusher whose keys had changed went through the heap in front of it, and nothing had been said.
TEST_F(BranchTest, KeysThatChangeBeforeItAreToldToJump)
{
    simulate("whole", {});
    const TakeBranch branch{folder / "whole", 1005};
    const std::string begin = "body.pusher.keys=[{frame=1003, position=[9, 1, 0]}, ";
    const auto told = [&](const std::string& name, const std::string& change) {
        simulate(name, {change}, branch);
        return notices;
    };
    simulate("same", {}, branch);
    EXPECT_EQ(notices, std::vector<std::string>());
    EXPECT_EQ(told("later", begin + "{frame=1005, position=[9, 2, 0]}, "
                                    "{frame=1009, position=[9, 9, 0]}]"),
              std::vector<std::string>());
    EXPECT_EQ(told("sooner", begin + "{frame=1005, position=[9, 2.5, 0]}]"),
              std::vector<std::string>{
                  "'pusher' stands at frame 1005 0.5 m from where its keys have it: it gets there "
                  "in one step, through whatever is in its way"});
}

TEST_F(BranchTest, WhoSleptWakesWhereSettingsAreOtherAndOnlyThere)
{
    const auto with = [](const std::string& change, const std::string& frames = "1001-1080") {
        return std::vector<std::string>{"shot.gravity=[3.0, -9.81, 0.0]",
                                        "shot.frames=\"" + frames + "\"", change};
    };
    const std::string nothing = "material.wood.friction=0.5";
    const TakeReader whole = simulate("whole", with(nothing));
    const TakeBranch branch{folder / "whole", 1075};
    constexpr BodyId kBlock = 1;
    const auto stateOf = [](const TakeReader& take, int frame) {
        return readFrameFile(take.paths().frame(frame));
    };
    const auto sleepsIn = [&](const TakeReader& take, int frame) {
        return stateOf(take, frame).contactMemory.isAsleep(kBlock);
    };
    ASSERT_TRUE(sleepsIn(whole, 1075));
    const TakeReader red = simulate("red", with("material.wood.color=[1, 0, 0]"), branch);
    const TakeReader hidden = simulate("hidden", with("body.block.visible=false"), branch);
    const TakeReader brief = simulate("brief", with(nothing, "1001-1077"), branch);
    EXPECT_FALSE(compareTakes(whole, red).difference);
    EXPECT_FALSE(compareTakes(whole, hidden).difference);
    EXPECT_TRUE(sleepsIn(brief, 1077));

    const TakeReader slippery = simulate("slippery", with("material.wood.friction=0.1"), branch);
    EXPECT_TRUE(sleepsIn(slippery, 1074));
    EXPECT_FALSE(sleepsIn(slippery, 1075));
    const auto placeIn = [&](int frame) {
        return stateOf(slippery, frame).motion[kBlock].position;
    };
    const double time = 5.0 / 24.0, acceleration = 3.0 - 0.1 * 9.81;
    EXPECT_NEAR(placeIn(1080).x() - placeIn(1075).x(), 0.5 * acceleration * time * time, 1e-3);
}

TEST_F(BranchTest, WhoWakesAtItLaysNoCountOfItsSleepToItsNext)
{
    const std::vector<std::string> asleepSoon = {"shot.frames=\"1001-1080\""};
    const TakeReader whole = simulate("whole", asleepSoon);
    const TakeBranch branch{folder / "whole", 1075};
    constexpr BodyId kBlock = 1;
    FrameState state = readFrameFile(whole.paths().frame(1075));
    ASSERT_TRUE(state.contactMemory.isAsleep(kBlock));
    state.contactMemory.rest[kBlock].unbalancedFrames = 7;
    writeFileBytes(whole.paths().frame(1075), encodeFrame(state));
    const TakeReader slippery =
        simulate("slippery", {asleepSoon[0], "material.wood.friction=0.1"}, branch);
    const BodyRest woken =
        readFrameFile(slippery.paths().frame(1075)).contactMemory.rest.at(kBlock);
    EXPECT_FALSE(woken.isAsleep);
    EXPECT_EQ(woken.unbalancedFrames, 0);
}

// What pulled at them when they fell asleep was held against other gravity: it was refused, as if
// they began elsewhere.
TEST_F(BranchTest, SleepersOfTheStartMayFeelOtherGravity)
{
    const std::string asleep = "body.away.start=\"asleep\"";
    simulate("whole", {asleep});
    const TakeBranch branch{folder / "whole", 1005};
    const TakeReader light = simulate("light", {asleep, "shot.gravity=[0, -3, 0]"}, branch);
    EXPECT_EQ(light.frames().size(), 9u);
    EXPECT_NE(refusalOf({}, branch).find("its bodies begin elsewhere"), std::string::npos);
}

TEST_F(BranchTest, TakesThatDifferInTheSignOfAZeroDiffer)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader other = simulate("other", {});
    const fs::path path = other.paths().frame(1001);
    FrameState state = readFrameFile(path);
    ASSERT_EQ(state.motion[2].velocity.x(), 0.0);
    state.motion[2].velocity.x() = -0.0;
    writeFileBytes(path, encodeFrame(state));
    const TakeComparison comparison = compareTakes(whole, other);
    ASSERT_TRUE(comparison.difference);
    EXPECT_EQ(comparison.difference->frame, 1001);
    EXPECT_EQ(comparison.difference->bodies, std::vector<std::string>{"away"});
}

TEST_F(BranchTest, TakesThatOnlyRememberOtherContactsDiffer)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader other = simulate("other", {});
    const fs::path path = other.paths().frame(1004);
    FrameState state = readFrameFile(path);
    ASSERT_FALSE(state.contactMemory.contacts.empty());
    state.contactMemory.contacts.front().force *= 2.0;
    writeFileBytes(path, encodeFrame(state));
    const TakeComparison comparison = compareTakes(whole, other);
    ASSERT_TRUE(comparison.difference);
    EXPECT_EQ(comparison.difference->frame, 1004);
    EXPECT_TRUE(comparison.difference->isMemoryOnly);
    EXPECT_EQ(comparison.difference->bodies, (std::vector<std::string>{"ground", "block"}));
}

TEST_F(BranchTest, AContactThatOneTakeAloneRemembersIsADifferenceWhicheverComesFirst)
{
    const TakeReader whole = simulate("whole", {});
    const TakeReader other = simulate("other", {});
    const fs::path path = other.paths().frame(1004);
    FrameState state = readFrameFile(path);
    ASSERT_FALSE(state.contactMemory.contacts.empty());
    RememberedContact more = state.contactMemory.contacts.back();
    more.b = 2;
    state.contactMemory.contacts.push_back(more);
    writeFileBytes(path, encodeFrame(state));
    for (const TakeComparison& comparison :
         {compareTakes(whole, other), compareTakes(other, whole)}) {
        ASSERT_TRUE(comparison.difference);
        EXPECT_EQ(comparison.difference->bodies, (std::vector<std::string>{"ground", "away"}));
    }
}

TEST_F(BranchTest, OtherBodiesAreRefusedWithWhatDiffers)
{
    simulate("whole", {});
    const TakeBranch branch{folder / "whole", 1005};
    EXPECT_NE(refusalOf({"material.wood.density=700"}, branch).find("mass of 'block'"),
              std::string::npos);
    EXPECT_NE(refusalOf({"shape.block.scale=1.5"}, branch).find("another"), std::string::npos);
    EXPECT_NE(refusalOf({"shot.fps=30"}, branch).find("frame rate"), std::string::npos);
    EXPECT_NE(refusalOf({}, TakeBranch{folder / "whole", 1010}).find("is none of the shot's"),
              std::string::npos);
    EXPECT_NE(refusalOf({}, TakeBranch{folder / "nowhere", 1005}).find("nowhere"),
              std::string::npos);
}

TEST_F(BranchTest, WhatItsFramesDoNotHoldIsNotPromised)
{
    simulate("whole", {});
    const TakeBranch branch{folder / "whole", 1005};
    EXPECT_NE(refusalOf({"output.subframes=[0, 0.25]"}, branch).find("output.subframes"),
              std::string::npos);
    EXPECT_NE(refusalOf({"output.contacts=true"}, branch).find("output.contacts"),
              std::string::npos);
    simulate("rich", {"output.subframes=[0, 0.25]", "output.contacts=true"});
    EXPECT_EQ(simulate("plain", {}, TakeBranch{folder / "rich", 1005}).frames().size(), 9u);
}

// Overwriting a take with a branch of itself emptied it, and so did a slip in --from.
TEST_F(BranchTest, NothingIsRemovedBeforeTheBranchIsKnownToBeGood)
{
    simulate("whole", {});
    simulate("target", {});
    copyWithout("whole", "damaged", [](const fs::path&) { return false; });
    std::string bytes = readFileBytes(TakePaths{folder / "damaged"}.frame(1003));
    bytes[700] ^= 1;
    writeFileBytes(TakePaths{folder / "damaged"}.frame(1003), bytes);
    const auto refusal = [&](const std::string& take, int frame,
                             const std::vector<std::string>& overrides = {}) {
        return refusalOf(overrides, TakeBranch{folder / take, frame}, "target",
                         ExistingTake::overwrite);
    };
    EXPECT_NE(refusal("nowhere", 1005).find("nowhere\": it is no take"), std::string::npos);
    EXPECT_NE(refusal("whole", 1010).find("is none of the shot's"), std::string::npos);
    EXPECT_NE(refusal("whole", 1005, {"material.wood.density=700"}).find("mass of 'block'"),
              std::string::npos);
    EXPECT_NE(refusal("damaged", 1005).find("frame.001003.scree"), std::string::npos);

    fs::create_directory_symlink(folder / "target", folder / "link");
    for (const char* itself : {"target", "link", "target/../target/."}) {
        EXPECT_NE(refusal(itself, 1005).find("the very take"), std::string::npos) << itself;
    }
}

// A branch that was killed while it began had frames and no take.json, and could not be resumed.
TEST_F(BranchTest, ABranchKilledAtAnyInstantOfItsBeginningGoesOnToTheSameBits)
{
    const std::vector<std::string> slippery = {"material.wood.friction=0.0"};
    simulate("whole", {});
    const TakeReader unbroken = simulate("branch", slippery, TakeBranch{folder / "whole", 1005});
    const auto numberOf = [](const fs::path& path) {
        const std::string name = path.filename();
        return name.starts_with("frame.") ? std::stoi(name.substr(6, 6)) : 0;
    };
    // The instants: the description is there, the shapes, the statistics, so many frames.
    const std::vector<std::function<bool(const fs::path&)>> instants = {
        [&](const fs::path& path) { return path.filename() != "take.json"; },
        [&](const fs::path& path) { return numberOf(path) > 0 || path.extension() == ".jsonl"; },
        [&](const fs::path& path) { return numberOf(path) > 0; },
        [&](const fs::path& path) { return numberOf(path) > 1003; },
        [&](const fs::path& path) { return numberOf(path) > 1005; }};
    for (std::size_t i = 0; i < instants.size(); ++i) {
        for (const bool isToldAgain : {false, true}) {
            copyWithout("branch", "killed", instants[i]);
            std::optional<TakeBranch> again;
            if (isToldAgain) again = TakeBranch{folder / "whole", 1005};
            const TakeReader resumed = simulate("killed", slippery, again, ExistingTake::resume);
            EXPECT_TRUE(compareTakes(unbroken, resumed).isSame()) << "instant " << i;
            EXPECT_EQ(resumed.stats().size(), unbroken.stats().size()) << "instant " << i;
            EXPECT_NO_THROW(resumed.describe()) << "instant " << i;
        }
    }
    // Before the first instant there is nothing that knows of a branch but the command.
    const TakeReader begun =
        simulate("begun", slippery, TakeBranch{folder / "whole", 1005}, ExistingTake::resume);
    EXPECT_TRUE(compareTakes(unbroken, begun).isSame());
}

TEST_F(BranchTest, FramesOfTheOriginalAreCopiedAgainFromThatVeryTakeOrNotAtAll)
{
    const std::vector<std::string> slippery = {"material.wood.friction=0.0"};
    const auto isHole = [](const fs::path& path) {
        return path.filename() == "frame.001003.scree";
    };
    simulate("whole", {});
    simulate("branch", slippery, TakeBranch{folder / "whole", 1005});
    copyWithout("branch", "hole", isHole);
    simulate("hole", slippery, std::nullopt, ExistingTake::resume);
    EXPECT_EQ(readFileBytes(TakePaths{folder / "hole"}.frame(1003)),
              readFileBytes(TakePaths{folder / "branch"}.frame(1003)));

    // The original has moved, or is simulated anew with other settings.
    const auto refusal = [&] {
        return test::refusalBy(
            [&] { simulate("hole", slippery, std::nullopt, ExistingTake::resume); });
    };
    copyWithout("branch", "hole", isHole);
    fs::rename(folder / "whole", folder / "moved");
    EXPECT_TRUE(refusal().mentions("--from"));
    simulate("whole", {"material.wood.friction=0.1"});
    EXPECT_TRUE(refusal().mentions("not what it was"));
    simulate("hole", slippery, TakeBranch{folder / "moved", 1005}, ExistingTake::resume);
    EXPECT_TRUE(compareTakes(TakeReader(folder / "branch"), TakeReader(folder / "hole")).isSame());
}

TEST_F(BranchTest, AResumeThatNamesAnotherBranchIsRefused)
{
    simulate("whole", {});
    simulate("branch", {}, TakeBranch{folder / "whole", 1005});
    const auto refusal = [&](const std::string& name, int frame) {
        return refusalOf({}, TakeBranch{folder / "whole", frame}, name, ExistingTake::resume);
    };
    EXPECT_NE(refusal("branch", 1004).find("branched off at frame 1005, not 1004"),
              std::string::npos);
    simulate("plain", {});
    EXPECT_NE(refusal("plain", 1005).find("not begun with --from"), std::string::npos);
}

TEST(ParseBranch, WantsATakeAndAFrame)
{
    EXPECT_EQ(parseBranch("takes/a@b@1080").take, "takes/a@b");
    EXPECT_EQ(parseBranch("takes/a@-5").frame, -5);
    for (const char* text : {"takes/a", "@1001", "takes/a@", "takes/a@10x", "takes/a@1001-1005"}) {
        EXPECT_THROW(parseBranch(text), Error) << text;
    }
}

}  // namespace
}  // namespace scree
