// check, diff, settle and sim --from, as a shell meets them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/file_bytes.h"
#include "io/pose_file.h"
#include "tests/support/small_shot.h"
#include "tests/support/support.h"

namespace scree {
namespace {

const std::string kShotText =
    test::shotTextOf({.name = "drop", .box = "[0.4, 0.2, 0.4]"},
                     test::bodyText("low", "position = [0, 0.15, 0]") +
                         test::bodyText("high", "position = [0.02, 0.4, 0.03]"));

class ShotTools : public testing::Test {
protected:
    struct Outcome {
        int code = -1;
        std::string out, err;
    };

    ShotTools() { writeFileBytes(folder / "drop.toml", kShotText); }

    Outcome run(const std::string& arguments) const
    {
        const std::string command = "cd '" + folder.path().string() + "' && '" + SCREE_PROGRAM +
                                    "' " + arguments + " > out 2> err";
        Outcome outcome;
        outcome.code = WEXITSTATUS(std::system(command.c_str()));
        outcome.out = readFileBytes(folder / "out");
        outcome.err = readFileBytes(folder / "err");
        return outcome;
    }

    std::vector<Pose> posesIn(const std::string& name) const
    {
        ProblemList problems(name);
        return readPoseFile(folder / name, {}, problems);
    }

    test::TemporaryFolder folder;
};

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST_F(ShotTools, CheckReportsShapesAndEstimateAsJson)
{
    const Outcome checked = run("check drop.toml --json --estimate 1");
    ASSERT_EQ(checked.code, 0) << checked.err;
    const nlohmann::json json = nlohmann::json::parse(checked.out);
    EXPECT_EQ(json["movable_bodies"], 2);
    EXPECT_NEAR(json["shapes"]["block"]["volume_m3"].get<double>(), 0.032, 1e-12);
    EXPECT_NEAR(json["shapes"]["block"]["heaviest_kg"].get<double>(), 20.8, 1e-9);
    EXPECT_NEAR(json["shapes"]["block"]["thinnest_m"].get<double>(), 0.2, 1e-9);
    EXPECT_EQ(json["shapes"]["block"]["sharp_edges"], 24);  // twelve, each of two segments
    EXPECT_EQ(json["shapes"]["block"]["round"], "no");
    EXPECT_EQ(json["estimate"]["frames_tried"], 1);
    EXPECT_GT(json["estimate"]["disk_bytes"], 0);
    EXPECT_TRUE(json["overlaps"].empty());
    EXPECT_TRUE(json["warnings"].empty()) << json["warnings"];
}

TEST_F(ShotTools, OverlapsAtTheStartAreAnErrorAWarningOrPushedApart)
{
    const std::string overlap = " --set body.high.position=[0.02,0.3,0.03]";
    const Outcome checked = run("check drop.toml --estimate 0" + overlap);
    EXPECT_EQ(checked.code, 65);
    EXPECT_TRUE(contains(checked.out, "low and high: 0.05 m")) << checked.out;

    const Outcome refused = run("sim drop.toml -o refused" + overlap);
    EXPECT_EQ(refused.code, 65);
    EXPECT_TRUE(contains(refused.err, "low and high: 0.05 m")) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "refused"));

    const Outcome warned =
        run("sim drop.toml -o warned --set start.overlap=\\\"warn\\\"" + overlap);
    EXPECT_TRUE(contains(warned.err, "Warning: 1 pair overlaps")) << warned.err;

    const Outcome apart =
        run("sim drop.toml -o apart --set start.overlap=\\\"separate\\\"" + overlap);
    EXPECT_EQ(apart.code, 0) << apart.err;
    EXPECT_TRUE(contains(apart.err, "pushed apart")) << apart.err;
}

// Dozens of lines told of as many crates that stand in each other in the same way.
TEST_F(ShotTools, OfManyOverlapsTheWorstAreToldAndTheOthersCounted)
{
    writeFileBytes(
        folder / "row.toml",
        test::shotTextOf({.name = "row"}, test::bodyText("crate",
                                                         "position = [0, 0.5, 0]\ngrid = { "
                                                         "count = [40, 1, 1], spacing = [0.9, "
                                                         "1, 1] }")));
    for (const char* command : {"sim row.toml -o t", "check row.toml --estimate 0"}) {
        const Outcome refused = run(command);
        EXPECT_EQ(refused.code, 65);
        const std::string text = refused.out + refused.err;
        EXPECT_TRUE(contains(text, "39 pairs overlap")) << text;
        EXPECT_TRUE(contains(text, "and 34 more, by 10 % and less")) << text;
        EXPECT_FALSE(contains(refused.err, "crate_0007")) << text;
        EXPECT_FALSE(contains(refused.out, "crate_0007")) << text;
    }
}

// Who is pressed was named, who presses was not.
TEST_F(ShotTools, AnOverlapNamesTheKeyedBodyThatPresses)
{
    const std::string lid =
        "motion = \"keyed\"\nkeys = [{ frame = 1001, position = [0, 1.3, 0] }, { frame = 1012, "
        "position = [0, 0.4, 0] }]\ninterpolate = \"linear\"\n";
    writeFileBytes(
        folder / "press.toml",
        test::shotTextOf({.name = "press", .frames = "1001-1012", .box = "[0.4, 0.4, 0.4]"},
                         test::bodyText("low", "position = [0, 0.2, 0]") +
                             test::bodyText("high", "position = [0, 0.6, 0]") +
                             test::bodyText("lid", lid)));
    const Outcome pressed = run("sim press.toml -o t");
    EXPECT_EQ(pressed.code, 79) << pressed.err;
    EXPECT_TRUE(
        contains(pressed.err, "; 'lid' has keys and gives way to nothing") ||
        contains(pressed.err, "; 'lid', the only one with keys that moves there, presses on them"))
        << pressed.err;
    writeFileBytes(
        folder / "inside.toml",
        test::shotTextOf({.name = "inside"}, test::bodyText("low", "position = [0, 0.5, 0]") +
                                                 test::bodyText("lid", lid)));
    const Outcome inside = run("check inside.toml --estimate 0");
    EXPECT_TRUE(contains(inside.err, "; 'lid' has keys and gives way to nothing")) << inside.err;
}

// A ball whose keys end where it is let go dropped to the ground, and nobody knew why.
TEST_F(ShotTools, WhatIsLetGoAtRestWhereItsKeysEndIsNoted)
{
    const auto check = [&](const std::string& more) {
        writeFileBytes(
            folder / "throw.toml",
            test::shotTextOf({.name = "throw"},
                             test::bodyText("ball",
                                            "motion = \"keyed\"\nkeys = [{ frame = 1001, position "
                                            "= [0, 2, 0] }, { frame = 1004, position = [1, 2, 0] "
                                            "}]\n" +
                                                more)));
        return run("check throw.toml --estimate 0").out;
    };
    EXPECT_TRUE(contains(check("release = 1004\n"),
                         "throw.toml:16:1: 'ball' is let go at frame 1004 at rest: smooth motion "
                         "ends at rest at its last key, at frame 1004; to throw it, give it a key "
                         "after its release, or interpolate = \"linear\""))
        << check("release = 1004\n");
    EXPECT_TRUE(contains(check("release = 1005\ninterpolate = \"linear\"\n"),
                         "at rest: its motion ends at its last key"));
    for (const char* meant :
         {"release = 1003\n", "release = 1004\ninterpolate = \"linear\"\n", "release = 1006\n", ""})
        EXPECT_FALSE(contains(check(meant), "let go")) << meant;
    check("release = 1004\n");
    EXPECT_TRUE(contains(run("sim throw.toml -o t").err, "'ball' is let go at frame 1004 at rest"));
}

// That some never came was told at the end of the night.
TEST_F(ShotTools, EmittersThatCannotEmitAllAreWarnedOfWithNumbers)
{
    const auto check = [&](const std::string& more, const std::string& frames = "1001-1025") {
        writeFileBytes(
            folder / "pour.toml",
            test::shotTextOf({.name = "pour", .frames = frames, .box = "[0.4, 0.4, 0.4]"},
                             "[[emitter]]\nname = \"pour\"\nshape = \"block\"\n"
                             "material = \"wood\"\n" +
                                 more));
        return run("check pour.toml --estimate 0").out;
    };
    // A block has left its place of 0.4 m after 0.29 s of falling: after 7 frames.
    const std::string one =
        "layout = { position = [0, 9, 0], grid = { count = [1, 1, 1], spacing = "
        "[1, 1, 1] } }\n";
    EXPECT_TRUE(contains(check("count = 100\n" + one),
                         "at least 96 of the 100 bodies of emitter 'pour' still wait at the last "
                         "frame, 1025"))
        << check("count = 100\n" + one);
    EXPECT_TRUE(contains(check("count = 100\nclear = \"skip\"\n" + one),
                         "at least 99 of the 100 bodies of emitter 'pour' are left out"));
    EXPECT_FALSE(contains(check("count = 4\n" + one), "emitter"));
    EXPECT_FALSE(contains(
        check("count = 100\nvelocity = [0, -10, 0]\nframes = \"1001-1101\"\n" + one, "1001-1120"),
        "emitter"));
    // So many that the end of the shot is not tried.
    const std::string box = "box = { min = [-1, 9, -1], max = [1, 10, 1] }\n";
    EXPECT_TRUE(contains(check("count = 5000\n" + box, "1001-1100"), ": about "))
        << check("count = 5000\n" + box, "1001-1100");
}

TEST_F(ShotTools, WhatBeginsInsideOfAMeshThatLooksInwardIsToldOfRooms)
{
    writeFileBytes(
        folder / "room.obj",
        "v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3\nv -3 4 -3\nv 3 4 -3\nv 3 4 3\nv -3 4 3\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    const auto shotWith = [](const std::string& mesh) {
        return std::string(kShotText) + "[shape.room]\nfile = \"room.obj\"\n" + mesh +
               "[[body]]\nname = \"room\"\nshape = \"room\"\nmaterial = \"wood\"\n"
               "motion = \"static\"\nposition = [0, -0.5, 0]\n";
    };
    writeFileBytes(folder / "full.toml", shotWith(""));
    const Outcome full = run("sim full.toml -o full");
    EXPECT_EQ(full.code, 65);
    EXPECT_TRUE(contains(full.err, "shape 'room' was inside-out")) << full.err;
    EXPECT_TRUE(contains(full.err, "repair = \"room\"")) << full.err;

    writeFileBytes(folder / "empty.toml",
                   shotWith("mesh = { repair = \"room\", thickness = 0.2 }\n"));
    const Outcome empty = run("check empty.toml --estimate 1");
    EXPECT_EQ(empty.code, 0) << empty.err;
    EXPECT_TRUE(contains(empty.out, "shape 'room': put walls of 0.2 m around it")) << empty.out;
}

TEST_F(ShotTools, WhatCannotBeMeantIsWarnedOf)
{
    const Outcome big = run("check drop.toml --estimate 0 --set shape.block.scale=500");
    EXPECT_TRUE(contains(big.out, "'low' is 200 m long and weighs 2.6e+06 t: are shot.units"))
        << big.out;
    EXPECT_TRUE(contains(big.out, "One unit is 1 m; in cm it would be 2 m, in mm 0.2 m long"))
        << big.out;
    // A plate modelled in centimetres and read as metres.
    const Outcome plate = run("check drop.toml --estimate 0 --set shape.block.box.size=[24,2,24]");
    EXPECT_TRUE(contains(plate.out, "'low' is 24 m long")) << plate.out;
    EXPECT_TRUE(contains(plate.out, "in cm it would be 0.24 m, in mm 0.024 m, in in 0.61 m long"))
        << plate.out;
    // Of many as odd as each other one is described.
    std::string shards = "scree = 1\n[shot]\nname = \"shards\"\nframes = \"1-2\"\n[material.a]\n";
    for (const std::string name : {"a", "b", "c"}) {
        shards += "[shape." + name + "]\nbox = { size = [60, 60, 60] }\n" + "[[body]]\nname = \"" +
                  name + "\"\nshape = \"" + name +
                  "\"\nmaterial = \"a\"\nmass = 1.0\nposition = [" +
                  std::to_string(100 * (name[0] - 'a')) + ", 0, 0]\n";
    }
    writeFileBytes(folder / "shards.toml", shards);
    const Outcome many = run("check shards.toml --estimate 0");
    EXPECT_TRUE(contains(many.out, "'a' is 60 m long")) << many.out << many.err;
    EXPECT_TRUE(contains(many.out, "; 2 more are as large: b, c")) << many.out;
    EXPECT_FALSE(contains(many.out, "'b' is 60 m long")) << many.out;
    // A density in the wrong unit; the unit of length the shot has is no other one.
    const Outcome lead = run("check drop.toml --estimate 0 --set material.wood.density=1e8");
    EXPECT_TRUE(contains(lead.out,
                         "are shot.units, the density and the asset's scale right? One "
                         "unit is 1 m; in in it would be 0.0102 m, in ft 0.122 m long"))
        << lead.out;
    // And the other way round: metres read as millimetres.
    const Outcome crumb = run("check drop.toml --estimate 0 --set shot.units=\\\"mm\\\"");
    EXPECT_TRUE(contains(crumb.out, "'low' is 0.0004 m long")) << crumb.out;
    EXPECT_FALSE(contains(run("check drop.toml --estimate 0").out, "shot.units"));
    // "immovable, of 1 kg/m3, inertia …" was told of what nothing moves.
    const Outcome fixed =
        run("check drop.toml --estimate 0 --set body.low.motion=\\\"static\\\" --set "
            "body.high.motion=\\\"static\\\"");
    EXPECT_TRUE(contains(fixed.out, "block: 2 bodies, immovable\n")) << fixed.out << fixed.err;
    const Outcome heavy = run("check drop.toml --estimate 0 --set shot.gravity=[0,-981,0]");
    EXPECT_TRUE(contains(heavy.out, "100 times the earth's")) << heavy.out;
    const Outcome away = run(
        "check drop.toml --estimate 0 --set shot.gravity=[0,9.81,0] --set shot.units=\\\"m\\\"");
    EXPECT_TRUE(contains(away.out, "2 bodies have nothing static under them: low, high") ||
                contains(away.out, "may fall for ever: low, high"))
        << away.out;
}

// Above a terrain whose faces are turned round all is solid: things would land on what nobody sees.
TEST_F(ShotTools, AGroundThatLooksDownIsWarnedOf)
{
    const auto checkWith = [&](const std::string& faces) {
        writeFileBytes(folder / "sheet.obj", "v 0 -9 0\nv 0 -9 4\nv 4 -9 4\nv 4 -9 0\n" + faces);
        writeFileBytes(folder / "sheet.toml",
                       kShotText +
                           "[shape.sheet]\nfile = \"sheet.obj\"\nmesh = { repair = "
                           "\"ground\" }\n" +
                           test::bodyText("sheet", "motion = \"static\"", "sheet"));
        return run("check sheet.toml --estimate 0");
    };
    const Outcome up = checkWith("f 1 2 3 4\n"), down = checkWith("f 4 3 2 1\n");
    EXPECT_TRUE(contains(up.out, "its faces look along +y")) << up.out << up.err;
    EXPECT_FALSE(contains(up.out, "look down"));
    EXPECT_TRUE(contains(down.out, "the faces of 'sheet' look down")) << down.out << down.err;
}

// Every corner of a copy lies on the surface of its twin, so that no contact tells of it.
TEST_F(ShotTools, ACopyThatNobodyMovedAwayIsToldAndComesOut)
{
    const std::string copy = " --set body.high.position=[0,0.15,0]";
    EXPECT_TRUE(contains(run("check drop.toml --estimate 0" + copy).out, "low and high: 0.1 m"));
    EXPECT_EQ(run("sim drop.toml -o refused" + copy).code, 65);
    const Outcome apart = run("sim drop.toml -o apart --set start.overlap=\\\"separate\\\"" + copy);
    EXPECT_EQ(apart.code, 0);
    EXPECT_TRUE(contains(apart.err, "They were pushed apart")) << apart.err;
    const Outcome warned = run("sim drop.toml -o warned --set start.overlap=\\\"warn\\\"" + copy);
    EXPECT_EQ(warned.code, 0) << warned.err;
    EXPECT_TRUE(contains(warned.err, "low and high: 0.1 m")) << warned.err;
}

TEST_F(ShotTools, WhatCannotBePushedApartIsRefused)
{
    writeFileBytes(folder / "low_ceiling.toml",
                   std::string(kShotText) +
                       "[[body]]\nname = \"ceiling\"\nmotion = \"static\"\n"
                       "material = \"wood\"\n"
                       "plane = { point = [0, 0.15, 0], normal = [0, -1, 0] }\n"
                       "[start]\noverlap = \"separate\"\n");
    const Outcome stays = run("sim low_ceiling.toml -o stays");
    EXPECT_EQ(stays.code, 65);
    EXPECT_TRUE(contains(stays.err, "could not be pushed apart")) << stays.err;
}

TEST_F(ShotTools, DiffEndsWithOneAndNamesTheFrameAndTheBody)
{
    ASSERT_EQ(run("sim drop.toml -o a").code, 0);
    ASSERT_EQ(run("sim drop.toml -o b --from a@1003").code, 0);
    ASSERT_EQ(run("sim drop.toml -o c --from a@1003 --set shot.gravity=[1,-9.81,0]").code, 0);
    const Outcome same = run("diff a b");
    EXPECT_EQ(same.code, 0) << same.out;
    EXPECT_TRUE(contains(same.out, "6 frames are the same")) << same.out;
    const Outcome other = run("diff a c --json");
    EXPECT_EQ(other.code, 1);
    const nlohmann::json json = nlohmann::json::parse(other.out);
    EXPECT_EQ(json["difference"]["frame"], 1004);
    EXPECT_EQ(json["difference"]["bodies"].size(), 2u);
    EXPECT_EQ(run("diff a nowhere").code, 66);
    EXPECT_EQ(run("sim drop.toml -o d --from a@1007").code, 65);
    EXPECT_EQ(run("sim drop.toml -o d --from a").code, 64);
}

TEST_F(ShotTools, SettleWaitsForWhatTheShotHasInStore)
{
    const auto settle = [&](const std::string& more, const std::string& options) {
        std::ofstream(folder / "later.toml") << readFileBytes(folder / "drop.toml") + more;
        return run("settle later.toml -o later.json" + options);
    };
    const std::string released =
        "[[body]]\nname = \"held\"\nshape = \"block\"\nmaterial = \"wood\"\n"
        "motion = \"keyed\"\nkeys = [{ frame = 1001, position = [3, 2, 0] }]\nrelease = 1040\n";
    const Outcome fallen = settle(released, "");
    ASSERT_EQ(fallen.code, 0) << fallen.err;
    const nlohmann::json json = nlohmann::json::parse(readFileBytes(folder / "later.json"));
    EXPECT_NEAR(json["bodies"].back()["position"][1].get<double>(), 0.1, 0.01);
    const Outcome early = settle(released, " --seconds 1.5");
    EXPECT_EQ(early.code, 79);
    EXPECT_TRUE(contains(early.err, "go on until")) << early.err;
    const std::string gust =
        "[[force]]\nname = \"gust\"\ntype = \"radial\"\n"
        "keys = [{ frame = 1001, strength = 0 }, { frame = 1060, strength = 0 }]\n";
    const Outcome blown = settle(gust, " --seconds 2");
    EXPECT_TRUE(contains(blown.err, "go on until")) << blown.err;
}

TEST_F(ShotTools, SettleSaysWhoHasNotBeenBornRatherThanWhoStillMoves)
{
    const auto settle = [&](const std::string& clear) {
        std::ofstream(folder / "stuck.toml")
            << readFileBytes(folder / "drop.toml") +
                   "[[body]]\nname = \"table\"\nshape = \"block\"\nmaterial = \"wood\"\n"
                   "motion = \"static\"\nposition = [9, 0.1, 0]\n"
                   "[[emitter]]\nname = \"late\"\nshape = \"block\"\nmaterial = \"wood\"\n"
                   "count = 2\nframes = \"1002-1003\"\nclear = \"" +
                   clear + "\"\nbox = { min = [9, 0.15, 0], max = [9, 0.15, 0] }\n";
        return run("settle stuck.toml -o stuck.json --seconds 4");
    };
    const Outcome waiting = settle("wait");
    EXPECT_EQ(waiting.code, 79);
    EXPECT_TRUE(contains(waiting.err, "'late_0000' has not been born yet")) << waiting.err;
    EXPECT_FALSE(contains(waiting.err, "still moves")) << waiting.err;
    EXPECT_EQ(settle("skip").code, 0);
}

TEST_F(ShotTools, CheckAndSettleSayWhatRollsOnForEverAndWhatStopsIt)
{
    std::ofstream(folder / "barrel.toml")
        << readFileBytes(folder / "drop.toml") +
               "[shape.barrel]\ncylinder = { radius = 0.3, height = 0.8, sectors = 32 }\n"
               "[[body]]\nname = \"one\"\nshape = \"barrel\"\nmaterial = \"wood\"\n"
               "position = [4, 0.3, 0]\nrotation = [90, 0, 0]\nvelocity = [1, 0, 0]\n";
    const std::string advice =
        "once it rolls, 'barrel' of material 'wood' rolls on for ever: nothing has a "
        "rolling_friction; 0.015 takes 1 m/s from it in three seconds";
    const Outcome checked = run("check barrel.toml --estimate 0");
    EXPECT_TRUE(contains(checked.out, advice)) << checked.out;
    const Outcome settled = run("settle barrel.toml -o barrel.json --seconds 6");
    EXPECT_EQ(settled.code, 79);
    EXPECT_TRUE(contains(settled.err, advice)) << settled.err;

    const std::string braked = " --set material.wood.rolling_friction=0.015";
    EXPECT_FALSE(contains(run("check barrel.toml --estimate 0" + braked).out, "rolls on"));
    EXPECT_EQ(run("settle barrel.toml -o barrel.json --seconds 6" + braked).code, 0);
    EXPECT_FALSE(contains(run("check drop.toml --estimate 0").out, "rolls on"));
}

TEST_F(ShotTools, SettleAndCheckRefuseABirthThatCannotBe)
{
    const std::string stuck =
        "[[body]]\nname = \"table\"\nshape = \"block\"\nmaterial = \"wood\"\n"
        "motion = \"static\"\nposition = [9, 0.1, 0]\n"
        "[[emitter]]\nname = \"late\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 2\nclear = "
        "\"fail\"\n"
        "frames = \"1002-1003\"\n"
        "box = { min = [9, 0.15, 0], max = [9, 0.15, 0] }\n";
    std::ofstream(folder / "stuck.toml") << readFileBytes(folder / "drop.toml") + stuck;
    for (const char* command : {"settle stuck.toml -o stuck.json", "check stuck.toml"}) {
        const Outcome outcome = run(command);
        EXPECT_EQ(outcome.code, 79) << command;
        EXPECT_TRUE(contains(outcome.err, "frame 1002: 'late_0000' cannot be born, 'table' stands"))
            << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "stuck.json"));
}

TEST_F(ShotTools, SettleWritesOnePoseOfBodiesAtRest)
{
    const Outcome settled = run("settle drop.toml -o pose.json");
    ASSERT_EQ(settled.code, 0) << settled.err;
    const nlohmann::json json = nlohmann::json::parse(readFileBytes(folder / "pose.json"));
    ASSERT_EQ(json["bodies"].size(), 3u);
    EXPECT_EQ(json["bodies"][2]["name"], "high");
    // On the ground and on each other, within the percent of overlap that goes unreported.
    EXPECT_NEAR(json["bodies"][1]["position"][1].get<double>(), 0.1, 0.004);
    EXPECT_NEAR(json["bodies"][2]["position"][1].get<double>(), 0.3, 0.008);
    const Outcome mesh = run("settle drop.toml -o pose.obj --seconds 0.1");
    EXPECT_EQ(mesh.code, 79);
    EXPECT_TRUE(contains(mesh.err, "still moves")) << mesh.err;
    EXPECT_TRUE(contains(readFileBytes(folder / "pose.obj"), "\nv "));
    // As an export takes it.
    EXPECT_EQ(run("settle drop.toml -o POSE.JSON").code, 0);
    EXPECT_EQ(readFileBytes(folder / "POSE.JSON"), readFileBytes(folder / "pose.json"));
    // Said at once, not after the run.
    const Outcome unknown = run("settle drop.toml -o pose.fbx --seconds 1e6 --tolerance 1e-12");
    EXPECT_EQ(unknown.code, 64);
    EXPECT_TRUE(contains(unknown.err, "'pose.fbx': expected a name ending in .poses, .json"))
        << unknown.err;
}

/// Two columns of the block that fall a little, and a plank beside them.
std::string columns(const std::string& more)
{
    return test::shotTextOf({.name = "heap", .box = "[0.4, 0.2, 0.4]"},
                            "[shape.plank]\nbox = { size = [1, 0.1, 0.3] }\n" +
                                test::bodyText("plank", "position = [3, 0.06, 0]", "plank") +
                                test::bodyText("brick", more));
}

// A heap is settled once and put into many shots.
TEST_F(ShotTools, WhatSettleWritesAsPosesOtherShotsRead)
{
    writeFileBytes(folder / "heap.toml",
                   columns("grid = { count = [2, 2, 1], spacing = [1, 0.21, 1] }\n"
                           "position = [0, 0.22, 0]"));
    const Outcome settled = run("settle heap.toml -o poses/heap.poses");
    ASSERT_EQ(settled.code, 0) << settled.err;
    EXPECT_EQ(settled.out, "poses/heap_plank.poses\nposes/heap_brick.poses\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "poses/heap.poses"));
    EXPECT_TRUE(readFileBytes(folder / "poses/heap_brick.poses")
                    .starts_with("# x y z qw qx qy qz of 4 of 'brick', shape 'block', settled in "
                                 "shot 'heap'\n"));
    writeFileBytes(folder / "again.toml",
                   columns("poses = \"poses/heap_brick.poses\"\nstart = \"asleep\""));
    const Outcome again = run("settle again.toml -o again.poses");
    ASSERT_EQ(again.code, 0) << again.err;
    // Who sleeps stays where it was put, but for the rounding on the way to its centre and back.
    const std::vector<Pose> before = posesIn("poses/heap_brick.poses");
    const std::vector<Pose> after = posesIn("again_brick.poses");
    ASSERT_EQ(after.size(), 4u);
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_LT((after[i].position - before[i].position).norm(), 1e-14);
        EXPECT_LT((after[i].orientation.coeffs() - before[i].orientation.coeffs()).norm(), 1e-14);
    }
}

TEST_F(ShotTools, PosesOfOneBodyAreInTheFileThatWasNamed)
{
    writeFileBytes(folder / "one.toml",
                   test::shotTextOf({.name = "one"}, test::bodyText("b",
                                                                    "position = [0, 0.51, "
                                                                    "0]")));
    const Outcome settled = run("settle one.toml -o one.poses");
    ASSERT_EQ(settled.code, 0) << settled.err;
    EXPECT_EQ(settled.out, "one.poses\n");
    EXPECT_TRUE(contains(readFileBytes(folder / "one.poses"), "of 1 of 'b'"));
}

TEST_F(ShotTools, PosesOfWhatIsNoCopyAreRefusedBeforeTheRun)
{
    ASSERT_EQ(run("settle drop.toml -o drop.obj --seconds 0.1").code, 79);
    const std::string import =
        "[[import]]\nfile = \"drop.obj\"\nnodes = \"high\"\nmaterial = "
        "\"wood\"\n";
    writeFileBytes(folder / "import.toml", test::shotTextOf({}, import));
    const Outcome refused = run("settle import.toml -o x.poses");
    EXPECT_EQ(refused.code, 64);
    EXPECT_TRUE(contains(refused.err, "'high' is a node of the [[import]] at import.toml:"))
        << refused.err;
    writeFileBytes(folder / "still.toml", test::shotTextOf({}, import + "motion = \"static\"\n"));
    const Outcome still = run("settle still.toml -o x.poses");
    EXPECT_EQ(still.code, 64);
    EXPECT_TRUE(contains(still.err, "all of the shot is static or keyed")) << still.err;
}

// It went through a file of its own, pose.1001.obj, which could be somebody else's.
TEST_F(ShotTools, SettleTouchesNoFileButTheOneItWrites)
{
    for (int frame = 1001; frame < 1010; ++frame)
        writeFileBytes(folder / ("pose." + std::to_string(frame) + ".obj"), "mine");
    ASSERT_EQ(run("settle drop.toml -o pose.obj --seconds 0.1").code, 79);
    for (int frame = 1001; frame < 1010; ++frame)
        EXPECT_EQ(readFileBytes(folder / ("pose." + std::to_string(frame) + ".obj")), "mine");
    EXPECT_EQ(run("settle drop.toml -o pose.pov --seconds 0.1").code, 79);
    EXPECT_TRUE(contains(readFileBytes(folder / "pose.pov"), "pose.pov_meshes.inc"));
    std::filesystem::create_directories(folder / "taken.obj");
    const Outcome taken = run("settle drop.toml -o taken.obj --seconds 0.1");
    EXPECT_EQ(taken.code, 73) << taken.err;
    // Neither does a place where nothing can be written cost the run.
    const Outcome nowhere = run("settle drop.toml -o /proc/pose.obj --seconds 1e6");
    EXPECT_EQ(nowhere.code, 73) << nowhere.err;
    EXPECT_FALSE(contains(nowhere.err, "at rest")) << nowhere.err;
    EXPECT_TRUE(contains(taken.err, "taken.obj")) << taken.err;
}

TEST_F(ShotTools, TheFiguresOfTheFirstFrameAreThoseOfTheStart)
{
    const std::string emitter =
        "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 2\n"
        "frames = \"1001\"\nbox = { min = [5, 1, 5], max = [9, 2, 9] }\n";
    writeFileBytes(folder / "moving.toml", kShotText + emitter);
    ASSERT_EQ(run("sim moving.toml -o t --frames 1002 --set body.high.velocity=[2,0,0]").code, 0);
    std::ifstream stats(folder / "t/stats.jsonl");
    std::string line;
    ASSERT_TRUE(std::getline(stats, line));
    const nlohmann::json first = nlohmann::json::parse(line);
    EXPECT_EQ(first["frame"], 1001);
    EXPECT_NEAR(first["kinetic_energy_J"].get<double>(), 0.5 * 20.8 * 4.0, 1e-9);
    EXPECT_NEAR(first["momentum"][0].get<double>(), 20.8 * 2.0, 1e-9);
    EXPECT_GT(first["potential_energy_J"].get<double>(), 20.8 * 9.81 * (0.15 + 0.4));
    EXPECT_EQ(first["births"]["born"], 2);
    EXPECT_EQ(first["bodies_awake"], 4);
}

// The copy went into caches unseen, and a branch off it ended in a failed check.
TEST_F(ShotTools, AFrameUnderTheNameOfAnotherIsRefused)
{
    ASSERT_EQ(run("sim drop.toml -o t").code, 0);
    const auto frame = [&](int number) {
        return folder / ("t/frames/frame.00" + std::to_string(number) + ".scree");
    };
    writeFileBytes(frame(1005), readFileBytes(frame(1004)));
    for (const char* command :
         {"export t -o x.abc", "render t", "sim drop.toml --from t@1005 -o b", "diff t t"}) {
        const Outcome refused = run(command);
        EXPECT_EQ(refused.code, 74) << command << ": " << refused.err;
        EXPECT_TRUE(contains(refused.err, "frame.001005.scree: holds frame 1004")) << refused.err;
    }
}

// A variable that a script never set took all frames, or wrote to another place.
TEST_F(ShotTools, EmptyValuesAndNumbersWithoutEndAreRefused)
{
    ASSERT_EQ(run("sim drop.toml -o t --frames 1002").code, 0);
    for (const char* command :
         {"export t -o x.abc --frames ''", "export t -o x.abc --frames=", "sim drop.toml -o ''",
          "sim drop.toml -o u --set ''", "render t --camera ''", "render t --size=", "info ''"}) {
        const Outcome refused = run(command);
        EXPECT_EQ(refused.code, 64) << command << ": " << refused.err;
        EXPECT_TRUE(contains(refused.err, "empty")) << refused.err;
    }
    for (const char* command :
         {"movie p.####.png -o x.mp4 --fps nan", "movie p.####.png -o x.mp4 --fps inf",
          "settle drop.toml -o x.json --tolerance nan", "settle drop.toml -o x.json --seconds nan"})
        EXPECT_EQ(run(command).code, 64) << command;
}

TEST_F(ShotTools, CheckTellsOverlapsAsSimDoes)
{
    const std::string check =
        "check drop.toml --estimate 0 --set body.high.position=[0.02,0.3,0.03]";
    const Outcome refused = run(check);
    EXPECT_EQ(refused.code, 65);
    EXPECT_TRUE(refused.err.starts_with("Error: 1 pair overlaps before anything moves"))
        << refused.err;
    const Outcome warned = run(check + " --set start.overlap=\\\"warn\\\"");
    EXPECT_EQ(warned.code, 0);
    EXPECT_TRUE(warned.err.starts_with("Warning: 1 pair overlaps")) << warned.err;
}

// A third too low: in the first frames nothing lies on anything yet.
TEST_F(ShotTools, TheEstimateOfTheDiskIsThatOfTheFinishedTake)
{
    std::string bodies;
    for (int i = 0; i < 12; ++i)
        bodies += test::bodyText("b" + std::to_string(i),
                                 "position = [" + std::to_string(i) + ", 0.3, 0]");
    writeFileBytes(folder / "row.toml", test::shotTextOf({.name = "row",
                                                          .frames = "1001-1100",
                                                          .shotKeys = "",
                                                          .woodKeys = "",
                                                          .box = "[0.4, 0.2, 0.4]"},
                                                         bodies));
    const Outcome checked = run("check row.toml --json");
    const double estimate =
        nlohmann::json::parse(checked.out)["estimate"]["disk_bytes"].get<double>();
    ASSERT_EQ(run("sim row.toml -o t").code, 0);
    double bytes = 0.0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "t"))
        if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
    EXPECT_NEAR(estimate, bytes, 0.15 * bytes);
}

TEST_F(ShotTools, OverwritingATakeRemovesItsPageOfFigures)
{
    const std::string two = " --set 'shot.frames=\"1001-1002\"'";
    ASSERT_EQ(run("sim drop.toml -o t" + two).code, 0);
    ASSERT_EQ(run("stats t --pictures 0").code, 0);
    ASSERT_TRUE(std::filesystem::exists(folder / "t/stats.html"));
    ASSERT_EQ(run("sim drop.toml -o t --overwrite" + two).code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "t/stats.html"));
}

// Too little memory was an error of the shot, at the line of the shape that came next.
TEST_F(ShotTools, ALackOfMemoryIsNotBlamedOnTheShot)
{
    bool ranOut = false;
    for (int megabytes = 300; megabytes <= 700; megabytes += 20) {
        const std::string command = "cd '" + folder.path().string() + "' && ulimit -v " +
                                    std::to_string(megabytes * 1024) + " && '" + SCREE_PROGRAM +
                                    "' check drop.toml --estimate 0 --threads 1 > out 2> err";
        const int code = WEXITSTATUS(std::system(command.c_str()));
        const std::string err = readFileBytes(folder / "err");
        if (code == 127 || code == 134) continue;  // not even the libraries start
        EXPECT_TRUE(code == 0 || code == 70) << code << ": " << err;
        if (code != 70) continue;
        ranOut = true;
        EXPECT_TRUE(err.starts_with("Error: memory ran out ")) << err;
    }
    EXPECT_TRUE(ranOut) << "no limit was tried at which the program starts and runs out";
}

TEST_F(ShotTools, AHeaderThatPromisesTooMuchIsToldAsALackOfMemory)
{
    writeFileBytes(folder / "big.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                   "property float y\nproperty float z\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n0 0 0\n");
    writeFileBytes(folder / "big.toml", kShotText + "[shape.big]\nfile = \"big.ply\"\n" +
                                            test::bodyText("b", "position = [5, 5, 5]", "big"));
    const Outcome refused = run("check big.toml --estimate 0");
    EXPECT_EQ(refused.code, 65);
    EXPECT_TRUE(contains(refused.err, "'big.ply' cannot be read: it needs more memory than"))
        << refused.err;
}

// The second was written over the first, and both were named.
TEST_F(ShotTools, PosesOfTwoThatWouldHaveOneFileAreRefusedAtOnce)
{
    const std::string emitter =
        "[[emitter]]\nname = \"rocks\"\nshape = [\"block\", \"slab\"]\nmaterial = \"wood\"\n"
        "count = 4\nbox = { min = [-3, 2, -3], max = [3, 6, 3] }\n";
    const std::string slab = "[shape.slab]\nbox = { size = [0.4, 0.1, 0.4] }\n";
    writeFileBytes(folder / "rocks.toml",
                   test::shotTextOf(
                       {}, slab + emitter + test::bodyText("rocks_slab", "position = [9, 1, 0]")));
    const Outcome refused = run("settle rocks.toml -o o.poses");
    EXPECT_EQ(refused.code, 64);
    EXPECT_TRUE(contains(refused.err, "'o_rocks_slab.poses'")) << refused.err;
}

// ffmpeg took what stands before a colon for a protocol.
TEST_F(ShotTools, AFilmMayHaveAColonInItsName)
{
    ASSERT_EQ(run("sim drop.toml -o sc01:v2 -q --set 'shot.frames=\"1001-1004\"'").code, 0);
    ASSERT_EQ(run("render sc01:v2 --size 32x32 -q").code, 0);
    for (const char* name : {"out:v2.mp4", "-x.mp4"}) {
        const Outcome film = run(std::string("movie sc01:v2 -q --output=") + name);
        EXPECT_EQ(film.code, 0) << film.err;
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
}

TEST_F(ShotTools, AFilmThatIsALinkIsMadeWhereItLeads)
{
    ASSERT_EQ(run("sim drop.toml -o t -q --set 'shot.frames=\"1001-1004\"'").code, 0);
    ASSERT_EQ(run("render t --size 32x32 -q").code, 0);
    std::filesystem::create_directories(folder / "disk");
    std::filesystem::create_symlink("disk/film.mp4", folder / "film.mp4");
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(run("movie t -q -o film.mp4").code, 0);
        EXPECT_TRUE(std::filesystem::is_symlink(folder / "film.mp4"));
        EXPECT_GT(std::filesystem::file_size(folder / "disk/film.mp4"), 100u);
    }
}

// They took --progress for an unknown option, and a farm their silence for a hang.
TEST_F(ShotTools, WhatWorksOnNoFramesTellsAFarmHowFarItIs)
{
    ASSERT_EQ(run("sim drop.toml -o t -q --set 'shot.frames=\"1001-1004\"'").code, 0);
    ASSERT_EQ(run("render t --size 32x32 -q").code, 0);
    for (const char* command :
         {"check drop.toml --estimate 1", "sheet t -o s.png",
          "sheet t/images/drop.1001.png -o s.png", "stats t -o s.html --pictures 2",
          "movie t -o m.mp4", "verify E6 --method scree"}) {
        const Outcome told = run(std::string(command) + " --progress alf");
        EXPECT_EQ(told.code, 0) << command << told.err;
        EXPECT_TRUE(contains(told.err, "ALF_PROGRESS 100%")) << command << told.err;
        EXPECT_FALSE(contains(run(command).err, "ALF_PROGRESS")) << command;
        EXPECT_EQ(run(std::string(command) + " --progress often").code, 64) << command;
    }
}

// What is written after the last frame came after 100 %.
TEST_F(ShotTools, AnExportIsDoneWhereItSaysSo)
{
    ASSERT_EQ(run("sim drop.toml -o t -q --set 'shot.frames=\"1001-1004\"'").code, 0);
    for (const char* name : {"x.usda", "x.instances.usda", "x.glb", "x.abc", "x.####.obj"}) {
        const Outcome told = run(std::string("export t --progress alf -o ") + name);
        ASSERT_EQ(told.code, 0) << told.err;
        EXPECT_TRUE(told.err.ends_with("ALF_PROGRESS 100%\n")) << name << told.err;
    }
    const std::string told = run("export t --progress alf -o x.usda").err;
    EXPECT_TRUE(contains(told, "ALF_PROGRESS 25%\n")) << told;  // four frames of sixteen
}

// They ended with 70: JSON holds UTF-8 alone, folders and names of files need not.
TEST_F(ShotTools, WhatIsNoUtf8IsReplacedInJson)
{
    const std::string latin = "dr\xf6p";
    std::filesystem::create_directories(folder / latin);
    writeFileBytes(folder / latin / "open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    writeFileBytes(
        folder / latin / "s.toml",
        test::shotTextOf({.frames = "1001"}, test::bodyText("low", "position = [0, 0.65, 0]")));
    const Outcome checked = run("check '" + latin + "/s.toml' --json --estimate 1");
    EXPECT_EQ(checked.code, 0) << checked.err;
    EXPECT_TRUE(nlohmann::json::accept(checked.out)) << checked.out;
}

}  // namespace
}  // namespace scree
