// Malformed shots and the whole message each of them must give. The head of every text takes three
// lines, so that what a case adds begins on line 4.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/shot_parser.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

const std::string kHead = "scree = 1\n[shot]\nname = \"s\"\n";
const std::string kMaterial = "[material.wood]\n";
const std::string kShape = "[shape.block]\nbox = {}\n";
// Lines 4 to 6; what follows begins on line 7.
const std::string kBase = kHead + kMaterial + kShape;

struct BadShot {
    const char* name;
    std::string text;
    std::string message;
};

/// The message of the error that the text gives; empty when it gives none.
std::string messageOf(const std::string& text, const std::vector<std::string>& overrides = {})
{
    try {
        parseShotText(text, "bad.toml", overrides);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::badInput);
        return error.what();
    }
    return "";
}

std::string body(const std::string& lines)
{
    return kBase + "[[body]]\nname = \"b\"\nmaterial = \"wood\"\n" + lines;
}

const char* const kMaterialKeys =
    "(valid: density, friction, restitution, rolling_friction, "
    "rolling_friction_raw, spinning_friction, spinning_friction_raw, color, roughness)";
const char* const kTables =
    "(valid: scree, extends, shot, solver, start, material, shape, body, force, pair, import, "
    "emitter, "
    "camera, render, output)";

std::vector<BadShot> badShots()
{
    const std::string many(12, 'x');
    return {
        {"SyntaxError", "scree = 1\n[shot\n",
         "bad.toml:2:6: Error while parsing table header: expected ']', saw '\\n'"},
        {"RepeatedKey", "scree = 1\nscree = 1\n",
         "bad.toml:2:9: Error while parsing key-value pair: cannot redefine existing integer "
         "'scree'"},
        {"KeyBeginsWithDot", "[.a]\n",
         "bad.toml:1:2: Error while parsing key: expected bare key starting character or "
         "string delimiter, saw '.'"},
        {"NotUtf8", "scree = 1 # \xff\n",
         "bad.toml:1:12: Encountered invalid utf-8 sequence; a shot is a text file in UTF-8"},
        {"TextWithoutQuotes", "scree = 1\n[shot]\nname = wall\n",
         "bad.toml:3:8: Error while parsing value: could not determine value type; a text stands "
         "in straight quotes, \"wood\", a list in square brackets, [0, 1, 0]"},
        {"NameOfAShotThatNoFolderCanHave",
         "scree = 1\n[shot]\nname = \"" + std::string(250, 'n') + "\"\n",
         "bad.toml:3:8: a name of 250 letters is too long for a folder: at most 200"},
        {"NameOfAShapeThatNoFileCanHave",
         kHead + "[shape." + std::string(250, 'n') + "]\nbox = {}\n",
         "bad.toml:4:8: a name of 250 letters is too long for a file: at most 200"},
        {"NumberOfFrames", kHead + "frames = 240\n",
         "bad.toml:4:10: 'frames' must be text in quotes, like \"1001-1240\", not 240"},
        {"NoVersion", "[shot]\nname = \"s\"\n", "bad.toml:1:1: the shot lacks 'scree': 1"},
        {"OtherVersion", "scree = 2\n[shot]\nname = \"s\"\n",
         "bad.toml:1:9: 'scree' must be 1, not 2"},
        {"NoShotTable", "scree = 1\n", "bad.toml:1:1: the shot lacks 'shot': a table"},
        {"NoName", "scree = 1\n[shot]\nfps = 24\n",
         "bad.toml:2:1: [shot] lacks 'name': text in quotes"},
        {"NameBeginsWithDigit", "scree = 1\n[shot]\nname = \"1st\"\n",
         "bad.toml:3:8: name \"1st\" must be letters, digits and _, not beginning with a digit"},
        {"UnknownKeyNearAnother", kHead + "[material.wood]\nfrction = 0.3\n",
         std::string("bad.toml:5:1: unknown key 'frction' in [material.wood]; did you mean "
                     "'friction'? ") +
             kMaterialKeys},
        {"UnknownKeyNearNothing", kHead + "[material.wood]\n" + many + " = 0.3\n",
         "bad.toml:5:1: unknown key '" + many + "' in [material.wood] " + kMaterialKeys},
        {"UnknownTable", kHead + "[materail.wood]\n",
         std::string(
             "bad.toml:4:2: unknown key 'materail' in the shot; did you mean 'material'? ") +
             kTables},
        {"UnknownKeyInInlineTable", kHead + "[solver]\nsubsteps = { mx = 3 }\n",
         "bad.toml:5:14: unknown key 'mx' in [solver] substeps; did you mean 'max'? (valid: min, "
         "max, safety)"},
        {"QuotedKeyWithDot", kHead + "[solver]\n\"substeps.max\" = 3\n",
         "bad.toml:5:1: unknown key 'substeps.max' in [solver]; did you mean 'substeps'? (valid: "
         "method, sleep, contact_sweeps, "
         "collision_iterations, collision_pair_impulses, contact_iterations, level_iterations, "
         "pair_impulses, shock_propagation, shock_pair_impulses, push_out, "
         "push_out_level_iterations, push_out_pair_impulses, orientation, substeps, maximum_spin, "
         "hover, penetration, strict, collision, combine)"},
        {"TextInsteadOfNumber", kHead + "fps = \"24\"\n",
         "bad.toml:4:7: 'fps' must be a number above 0 and below 10000, not \"24\""},
        {"NumberInsteadOfInteger", kHead + "[solver]\ncontact_iterations = 2.5\n",
         "bad.toml:5:22: 'contact_iterations' must be a whole number from 0 to 1000, not 2.5"},
        {"IntegerOutOfRange", kHead + "[solver]\ncontact_iterations = -1\n",
         "bad.toml:5:22: 'contact_iterations' must be a whole number from 0 to 1000, not -1"},
        {"NumberInsteadOfBoolean", kHead + "[solver]\npush_out = 1\n",
         "bad.toml:5:12: 'push_out' must be true or false, not 1"},
        {"DateInsteadOfNumber", kHead + "fps = 1979-05-27\n",
         "bad.toml:4:7: 'fps' must be a number above 0 and below 10000, not a date"},
        {"TableInsteadOfList", kBase + "[body]\nname = \"b\"\n",
         "bad.toml:7:1: 'body' must be a list of tables: [[body]], not a table"},
        {"MaterialWithoutName", kHead + "[material]\ndensity = 3\n",
         "bad.toml:5:1: 'material' must be tables, each with a name: [material.NAME]; 'density' is "
         "no table"},
        {"InfiniteNumber", kHead + "[material.wood]\nfriction = inf\n",
         "bad.toml:5:12: 'friction' must be a number of at least 0, not inf"},
        {"NotANumber", body("shape = \"block\"\nposition = [0, nan, 0]\n"),
         "bad.toml:11:16: 'position' must be 3 numbers [x, y, z], not nan"},
        {"TooFewNumbers", kHead + "gravity = [0, -9.81]\n",
         "bad.toml:4:11: 'gravity' must be 3 numbers [x, y, z], not [0, -9.81]"},
        {"NegativeFriction", kHead + "[material.wood]\nfriction = -0.1\n",
         "bad.toml:5:12: 'friction' must be a number of at least 0, not -0.1"},
        {"RestitutionAboveOne", kHead + "[material.wood]\nrestitution = 1.5\n",
         "bad.toml:5:15: 'restitution' must be a number from 0 to 1, not 1.5"},
        {"NoDensity", kHead + "[material.wood]\ndensity = 0\n",
         "bad.toml:5:11: 'density' must be a number above 0, not 0"},
        {"UnknownWord", kHead + "units = \"metre\"\n",
         "bad.toml:4:9: 'units' must be one of \"m\", \"cm\", \"mm\", \"in\", \"ft\", not "
         "\"metre\""},
        {"MisspeltWord", body("shape = \"block\"\nmotion = \"statik\"\n"),
         "bad.toml:11:10: 'motion' must be one of \"dynamic\", \"static\", \"keyed\", not "
         "\"statik\"; did you mean 'static'?"},
        {"MethodNobodyKnows", kHead + "[solver]\nmethod = \"scre\"\n",
         "bad.toml:5:10: 'method' must be one of \"scree\", \"paper\", not \"scre\"; did you mean "
         "'scree'?"},
        {"StrictScree", kHead + "[solver]\nstrict = true\n",
         "bad.toml:5:10: 'strict' is the paper without its repairs: it needs method = \"paper\""},
        {"KeyedWithoutKeys", body("shape = \"block\"\nmotion = \"keyed\"\n"),
         "bad.toml:7:1: a keyed body needs 'keys', for example keys = [{ frame = 1001, position = "
         "[0, 0, 0] }]"},
        {"KeysOutOfOrder",
         body(
             "shape = \"block\"\nmotion = \"keyed\"\nkeys = [{ frame = 5, position = [0, 0, 0] },\n"
             "{ frame = 5, position = [1, 0, 0] }]\n"),
         "bad.toml:13:11: keys must be in order of time, no two at the same: 5.0 after 5.0"},
        {"KeyOfAnUnknownName",
         body("shape = \"block\"\nmotion = \"keyed\"\nkeys = [{ frame = 5, positon = [0, 0, 0] "
              "}]\n"),
         "bad.toml:12:22: unknown "
         "key 'positon' in [[keys]]; did you mean 'position'? (valid: "
         "frame, position, rotation, orientation)"},
        {"KeysOfADynamicBody", body("shape = \"block\"\nrelease = 1010\n"),
         "bad.toml:11:11: 'release' is for bodies with motion = \"keyed\""},
        {"ReleaseBeforeTheShot",
         body(
             "shape = \"block\"\nmotion = \"keyed\"\nkeys = [{ frame = 5, position = [0, 0, 0] }]\n"
             "release = 1001\n"),
         "bad.toml:13:11: 'release' must be a frame after the first, 1001; a body that is free "
         "from "
         "the beginning has motion = \"dynamic\""},
        {"TakenOverBeforeTheShot",
         body(
             "shape = \"block\"\nmotion = \"keyed\"\nkeys = [{ frame = 5, position = [0, 0, 0] }]\n"
             "keyed_from = 1001\n"),
         "bad.toml:13:14: 'keyed_from' must be a frame after the first, 1001; without it a body is "
         "keyed from the beginning"},
        {"ReleasedBeforeItIsTakenOver",
         body(
             "shape = \"block\"\nmotion = \"keyed\"\nkeys = [{ frame = 5, position = [0, 0, 0] }]\n"
             "keyed_from = 1010\nrelease = 1010\n"),
         "bad.toml:14:11: 'release' must be a frame after 'keyed_from', 1010"},
        {"PositionBesideKeys",
         body("shape = \"block\"\nposition = [0, 0, 0]\nmotion = \"keyed\"\n"
              "keys = [{ frame = 5, position = [0, 0, 0] }]\n"),
         "bad.toml:13:1: 'keys' cannot stand beside 'position' in [[body]]"},
        {"ForceOnAStaticBody", body("shape = \"block\"\nmotion = \"static\"\nforce = [1, 0, 0]\n"),
         "bad.toml:12:9: nothing moves this body, so it has no 'force'"},
        {"UnknownGroup", body("shape = \"block\"\ngroup = \"props\"\ncollides = [\"porps\"]\n"),
         "bad.toml:12:13: no body has group = \"porps\"; did you mean 'props'? (known: props)"},
        {"WindWithoutDirection", kBase + "[[force]]\ntype = \"wind\"\nstrength = 3\n",
         "bad.toml:7:1: a force of type \"wind\" needs a 'direction'"},
        {"ForceOnAnUnknownGroup",
         kBase + "[[force]]\ntype = \"radial\"\nstrength = 3\ngroups = [\"leaves\"]\n",
         "bad.toml:10:11: no body has group = \"leaves\""},
        {"FalloffWithoutReach",
         kBase + "[[force]]\ntype = \"radial\"\nstrength = 3\nfalloff = \"linear\"\n",
         "bad.toml:10:11: a 'falloff' needs a 'reach'"},
        {"UnknownForce", kBase + "[[force]]\ntype = \"magnet\"\nstrength = 3\n",
         "bad.toml:8:8: 'type' must be one of \"wind\", \"radial\", \"vortex\", \"uniform\", not "
         "\"magnet\""},
        {"PairOfAnUnknownMaterial", kBase + "[[pair]]\nof = [\"wood\", \"wod\"]\nfriction = 0.1\n",
         "bad.toml:8:15: no [material.wod] in the shot; did you mean 'wood'? (known: wood)"},
        {"PairOfThree", kBase + "[[pair]]\nof = [\"wood\"]\nfriction = 0.1\n",
         "bad.toml:8:6: 'of' must name two materials, like [\"steel\", \"wood\"]"},
        {"PairWithoutAWord", kBase + "[[pair]]\nof = [\"wood\", \"wood\"]\n",
         "bad.toml:7:1: [[pair]] says neither 'friction' nor 'restitution'"},
        {"UnknownRule", kHead + "[solver]\ncombine = { friction = \"maxi\" }\n",
         "bad.toml:5:24: 'friction' must be one of \"min\", \"max\", \"mean\", \"geometric\", "
         "\"multiply\", not \"maxi\"; did you mean 'max'?"},
        {"Emitter", kHead + "[[emitter]]\nname = \"e\"\n",
         "bad.toml:4:1: [[emitter]] lacks 'shape': text in quotes, or a list of such texts\n"
         "bad.toml:4:1: [[emitter]] lacks 'material': text in quotes\n"
         "bad.toml:4:1: [[emitter]] lacks 'count': a whole number from 1 to 1000000\n"
         "bad.toml:4:1: [[emitter]] 'e' does not say where: give it box, layout or poses"},
        {"EmitterOfUnknownShape",
         kBase + "[[emitter]]\nname = \"e\"\nshape = [\"block\", \"blok\"]\nmaterial = \"wood\"\n" +
             "count = 3\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\n",
         "bad.toml:9:19: no [shape.blok] in the shot; did you mean 'block'? (known: block)"},
        {"EmitterOutsideTheShot",
         kBase + "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 3\n" +
             "frames = \"900-1000\"\nbox = { min = [0, 2, 0], max = [1, 1, 1] }\nweights = [1, "
             "2]\n" +
             "clear = \"wate\"\ntilt = 200\n",
         "bad.toml:12:10: births must lie in the frames of the shot, 1001-1240, not \"900-1000\"\n"
         "bad.toml:13:15: 'min' must not exceed 'max', [1.0, 1.0, 1.0]\n"
         "bad.toml:14:11: 'weights' must be as many as the shapes, 1, not 2\n"
         "bad.toml:15:9: 'clear' must be one of \"wait\", \"skip\", \"fail\", not \"wate\"; did "
         "you mean "
         "'wait'?\n"
         "bad.toml:16:8: 'tilt' must be a number from 0 to 180, or \"random\", not 200"},
        {"NegativeRollingFriction", kHead + "[material.wood]\nrolling_friction = -0.1\n",
         "bad.toml:5:20: 'rolling_friction' must be a number of at least 0, not -0.1"},
        {"MisspeltRollingFriction", kHead + "[material.wood]\nroling_friction = 0.1\n",
         "bad.toml:5:1: unknown key 'roling_friction' in [material.wood]; did you mean "
         "'rolling_friction'? (valid: density, friction, restitution, rolling_friction, "
         "rolling_friction_raw, spinning_friction, spinning_friction_raw, color, roughness)"},
        {"RollingFrictionTwice",
         kHead + "[material.wood]\nrolling_friction = 0.1\nrolling_friction_raw = 0.1\n",
         "bad.toml:6:1: 'rolling_friction_raw' cannot stand beside 'rolling_friction' in "
         "[material.wood]"},
        {"ExactTorus", kHead + "[shape.ring]\ntorus = {}\ncollide = \"exact\"\n",
         "bad.toml:6:11: collide = \"exact\" is for a sphere, box or cylinder; anything else "
         "collides as its mesh"},
        {"ExactEllipsoid",
         kHead + "[shape.egg]\nsphere = {}\nscale = [1, 2, 1]\ncollide = \"exact\"\n",
         "bad.toml:6:9: 'scale' must keep the circles of an exact shape round"},
        {"ExactShapeWithAField",
         kHead + "[shape.ball]\nsphere = {}\nsdf = { resolution = 64 }\ncollide = \"exact\"\n",
         "bad.toml:6:7: a shape that collides as \"exact\" has no sampled field"},
        {"ExactShapeWithNormals",
         kHead + "[shape.ball]\nsphere = {}\nnormals = \"smooth\"\ncollide = \"exact\"\n",
         "bad.toml:6:11: a shape that collides as \"exact\" has exact normals"},
        {"ExactShapeOfNoKnownKind", kHead + "[shape.ball]\nsphere = {}\ncollide = \"exakt\"\n",
         "bad.toml:6:11: 'collide' must be one of \"mesh\", \"exact\", not \"exakt\"; did you mean "
         "'exact'?"},
        {"ExtendsANumber", "extends = 3\n" + kHead,
         "bad.toml:1:11: 'extends' must be text in quotes, not 3"},
        {"ExtendsItself", "extends = \"bad.toml\"\n" + kHead,
         "bad.toml:1:11: 'extends' goes round in a circle: \"bad.toml\" extends this shot"},
        {"ShellWithoutThickness", kHead + "[shape.a]\nbox = {}\nmesh = { repair = \"shell\" }\n",
         "bad.toml:6:19: \"shell\" needs a 'thickness'"},
        {"SolidifyWithoutThickness",
         kHead + "[shape.a]\nbox = {}\nmesh = { repair = \"solidify\" }\n",
         "bad.toml:6:19: \"solidify\" needs a 'thickness'"},
        {"ThicknessWithoutShell", kHead + "[shape.a]\nbox = {}\nmesh = { thickness = 1 }\n",
         "bad.toml:6:22: only \"shell\", \"ground\", \"room\" and \"solidify\" have a 'thickness'"},
        {"StartOverlap", kHead + "[start]\noverlap = \"wran\"\n",
         "bad.toml:5:11: 'overlap' must be one of \"error\", \"warn\", \"separate\", not \"wran\"; "
         "did you mean 'warn'?"},
        {"Contacts", kHead + "[output]\ncontacts = 1\n",
         "bad.toml:5:12: 'contacts' must be true or false, not 1"},
        {"SubframesThatSpanAFrame", kHead + "[output]\nsubframes = [-0.5, 0.0, 0.5]\n",
         "bad.toml:5:13: 'subframes' must lie within one frame and at least 0.01 frames apart, "
         "like [-0.25, 0.0, 0.25], not [-0.5, 0.0, 0.5]"},
        {"SubframesTooClose", kHead + "[output]\nsubframes = [0.001]\n",
         "bad.toml:5:13: 'subframes' must lie within one frame and at least 0.01 frames apart, "
         "like [-0.25, 0.0, 0.25], not [0.001]"},
        {"SubframesThatAreNoList", kHead + "[output]\nsubframes = 0.25\n",
         "bad.toml:5:13: 'subframes' must be a list of numbers, each above -1 and below 1, not "
         "0.25"},
        {"ExportOfNoKnownFormat", kHead + "[output]\nexport = [\"glb\", \"abd\"]\n",
         "bad.toml:5:18: 'export' must be a list of words from \"abc\", \"usda\", "
         "\"instances.usda\", \"glb\", \"obj\", \"ply\", \"pov\", not \"abd\"; did you mean "
         "'abc'?"},
        {"UnknownShape", body("shape = \"blok\"\n"),
         "bad.toml:10:9: no [shape.blok] in the shot; did you mean 'block'? (known: block)"},
        {"UnknownMaterial", kBase + "[[body]]\nname = \"b\"\nshape = \"block\"\nmaterial = \"w\"\n",
         "bad.toml:10:12: no [material.w] in the shot (known: wood)"},
        {"NoMaterial", kBase + "[[body]]\nname = \"b\"\nshape = \"block\"\n",
         "bad.toml:7:1: [[body]] lacks 'material': text in quotes"},
        {"NeitherShapeNorPlane", body(""),
         "bad.toml:7:1: [[body]] 'b' has neither 'shape' nor 'plane'"},
        {"BothShapeAndPlane",
         body("shape = \"block\"\nmotion = \"static\"\nplane = { normal = [0, 1, 0] }\n"),
         "bad.toml:12:1: 'plane' cannot stand beside 'shape' in [[body]]"},
        {"DynamicPlane", body("plane = { normal = [0, 1, 0] }\n"),
         "bad.toml:10:9: a plane cannot move: write motion = \"static\""},
        {"PlaneWithoutDirection", body("motion = \"static\"\nplane = { normal = [0, 0, 0] }\n"),
         "bad.toml:11:20: 'normal' must not be zero"},
        {"MovingStaticBody",
         body("shape = \"block\"\nmotion = \"static\"\nvelocity = [0, 1, 0]\n"
              "mass = 2\n"),
         "bad.toml:12:12: a static body has no 'velocity'\n"
         "bad.toml:13:8: a static body has no 'mass': nothing moves it"},
        {"RotationTwice",
         body("shape = \"block\"\nrotation = [0, 0, 0]\norientation = [1, 0, 0, 0]\n"),
         "bad.toml:12:1: 'orientation' cannot stand beside 'rotation' in [[body]]"},
        {"ZeroOrientation", body("shape = \"block\"\norientation = [0, 0, 1e-12, 0]\n"),
         "bad.toml:11:15: 'orientation' must not be zero"},
        {"SameNameTwice",
         body("shape = \"block\"\n[[body]]\nname = \"b\"\nmaterial = \"wood\"\n"
              "shape = \"block\"\n"),
         "bad.toml:12:8: body name 'b' is taken by the body at bad.toml:8:8"},
        {"SameNameTwiceAndMoreAmiss",
         body("shape = \"block\"\n[[body]]\nname = \"b\"\nmaterial = \"wod\"\n"
              "shape = \"block\"\nmotion = \"static\"\nvelocity = [1, 0, 0]\n"),
         "bad.toml:12:8: body name 'b' is taken by the body at bad.toml:8:8\n"
         "bad.toml:13:12: no [material.wod] in the shot; did you mean 'wood'? (known: wood)\n"
         "bad.toml:16:12: a static body has no 'velocity'"},
        {"NameOfACopy",
         body("shape = \"block\"\ngrid = { count = [2, 1, 1], spacing = [2, 2, 2] }\n"
              "[[body]]\nname = \"b_0001\"\nmaterial = \"wood\"\nshape = \"block\"\n"),
         "bad.toml:13:8: body name 'b_0001' is taken by the body at bad.toml:8:8"},
        {"NameOfAGrid",
         body("shape = \"block\"\ngrid = { count = [2, 1, 1], spacing = [2, 2, 2] }\n"
              "[[body]]\nname = \"b\"\nmaterial = \"wood\"\nshape = \"block\"\n"),
         "bad.toml:13:8: body name 'b' is taken by the body at bad.toml:8:8"},
        {"NameWithSpace",
         kBase + "[[body]]\nname = \"a b\"\nmaterial = \"wood\"\nshape = \"block\"\n",
         "bad.toml:8:8: name \"a b\" must be letters, digits and _, not beginning with a digit"},
        {"TooManyBodies",
         body("shape = \"block\"\ngrid = { count = [1000, 1000, 2], spacing = [2, 2, 2] }\n"),
         "bad.toml:11:18: the shot has more than 1000000 bodies"},
        {"GridAndPoses",
         body("shape = \"block\"\nposes = \"none.poses\"\n"
              "grid = { count = [1, 1, 1], spacing = [2, 2, 2] }\n"),
         "bad.toml:11:9: pose file 'none.poses' does not exist\n"
         "bad.toml:12:1: 'grid' cannot stand beside 'poses' in [[body]]"},
        {"FramesBackwards", kHead + "frames = \"1240-1001\"\n",
         "bad.toml:4:10: 'frames' must not end before they begin: \"1240-1001\""},
        {"FramesWithLetters", kHead + "frames = \"1001-end\"\n",
         "bad.toml:4:10: 'frames' must be \"FIRST-LAST\", for example \"1001-1240\", not "
         "\"1001-end\""},
        {"SubstepsCrossed", kHead + "[solver]\nsubsteps = { min = 9, max = 3 }\n",
         "bad.toml:5:20: 'min' sub-steps must not exceed 'max', 3"},
        {"PenetrationCrossed", kHead + "[solver]\npenetration = { warn = 0.5 }\n",
         "bad.toml:5:24: 'warn' must not exceed 'fail', 0.1"},
        {"ShapeWithoutForm", kHead + "[shape.a]\nscale = 2\n",
         "bad.toml:4:8: [shape.a] says nothing of its form; give it torus, box, sphere, cylinder, "
         "capsule or file"},
        {"ShapeWithTwoForms", kHead + "[shape.a]\nbox = {}\nsphere = {}\n",
         "bad.toml:6:1: 'sphere' cannot stand beside 'box' in [shape.a]"},
        {"RingWithoutHole", kHead + "[shape.a]\ntorus = { major = 1, minor = 1 }\n",
         "bad.toml:5:30: 'minor' must be less than 'major', or the ring has no hole"},
        {"TooFewSegments", kHead + "[shape.a]\ntorus = { segments = [16, 2] }\n",
         "bad.toml:5:27: 'segments' must be 2 whole numbers, each from 3 to 1024, not 2"},
        {"NegativeSize", kHead + "[shape.a]\nbox = { size = [1, -1, 1] }\n",
         "bad.toml:5:20: 'size' must be 3 numbers [x, y, z], each above 0, not -1"},
        {"ZeroScale", kHead + "[shape.a]\nbox = {}\nscale = 0\n",
         "bad.toml:6:9: 'scale' must be a number above 0, or 3 such numbers [x, y, z], not 0"},
        {"ResolutionAndVoxel",
         kHead + "[shape.a]\nbox = {}\nsdf = { resolution = 64, voxel = 0.1 }\n",
         "bad.toml:6:26: 'voxel' cannot stand beside 'resolution' in [shape.a] sdf"},
        {"FlatView", kHead + "[[camera]]\neye = [1, 1, 1]\nfov = 180\n",
         "bad.toml:6:7: 'fov' must be a number above 0 and below 180, not 180"},
        {"CameraBeyondWhatRaysReach", kHead + "[[camera]]\neye = [1, 2e9, 1]\n",
         "bad.toml:5:11: 'eye' must be 3 numbers [x, y, z], each from -1000000000 to 1000000000, "
         "not 2e+09"},
        {"CameraInItsTarget", kHead + "[[camera]]\neye = [0, 0, 0]\n",
         "bad.toml:5:7: 'eye' must not be where 'target' is"},
        {"TwoCamerasOfOneName",
         kHead + "[[camera]]\neye = [1, 0, 0]\n[[camera]]\nname = \"main\"\neye = [2, 0, 0]\n",
         "bad.toml:7:8: camera name 'main' is taken by another camera"},
        {"ThreeCamerasOfOneName",
         kHead + "[[camera]]\neye = [1, 0, 0]\n[[camera]]\neye = [2, 0, 0]\n[[camera]]\n"
                 "name = \"main\"\neye = [3, 0, 0]\n",
         "bad.toml:6:1: camera name 'main' is taken by another camera\n"
         "bad.toml:9:8: camera name 'main' is taken by another camera"},
        {"CameraNowhere", kHead + "[[camera]]\ntarget = [1, 0, 0]\n",
         "bad.toml:4:1: camera 'main' needs 'eye', 'keys', 'orbit' or 'file' to stand somewhere"},
        {"CameraWithEyeAndOrbit", kHead + "[[camera]]\neye = [1, 0, 0]\norbit = { radius = 3 }\n",
         "bad.toml:6:1: 'orbit' cannot stand beside 'eye' in [[camera]]"},
        {"CameraKeysBackwards",
         kHead + "[[camera]]\nkeys = [{ frame = 5, eye = [1, 0, 0] }, { frame = 4, eye = [2, 0, 0] "
                 "}]\n",
         "bad.toml:5:51: the frames of 'keys' must ascend, but 4.0 comes after 5.0"},
        {"CameraWithoutKeys", kHead + "[[camera]]\nkeys = []\n",
         "bad.toml:5:8: 'keys' must hold at least one key"},
        {"CameraKeyWithoutEye", kHead + "[[camera]]\nkeys = [{ frame = 5, eyes = [1, 0, 0] }]\n",
         "bad.toml:5:22: unknown key 'eyes' in [[keys]]; did you mean 'eye'? (valid: frame, eye, "
         "target, fov)"},
        {"CameraKeyInItsTarget", kHead + "[[camera]]\nkeys = [{ frame = 5, eye = [0, 0, 0] }]\n",
         "bad.toml:5:28: 'eye' must not be where 'target' is"},
        {"OrbitWithoutRadius", kHead + "[[camera]]\norbit = { height = 3 }\n",
         "bad.toml:5:9: [[camera]] orbit lacks 'radius': a number above 0 and below 1000000000"},
        {"OrbitBackwards", kHead + "[[camera]]\norbit = { radius = 3, frames = \"9-4\" }\n",
         "bad.toml:5:32: 'frames' must be \"FIRST-LAST\", for example \"1001-1240\", not \"9-4\""},
        {"StillOfAnotherShot", kHead + "[render]\nstill = 900\n",
         "bad.toml:5:9: 'still' must be one of the shot's frames, 1001 to 1240"},
        {"PictureTooLarge", kHead + "[render]\nsize = [1280, 99999]\n",
         "bad.toml:5:15: 'size' must be 2 whole numbers, each from 16 to 16384, not 99999"},
    };
}

TEST(ShotErrors, EveryMalformedShotGivesItsWholeMessage)
{
    for (const BadShot& shot : badShots()) {
        EXPECT_EQ(messageOf(shot.text), shot.message) << "in the case " << shot.name;
    }
}

TEST(ShotErrors, AllProblemsOfAFileComeAtOnceInTheOrderOfTheText)
{
    const std::string message = messageOf(
        "scree = 1\n[shot]\nnme = \"s\"\nfps = 0\n[material.wood]\nfriction = -1\n"
        "[[body]]\nname = \"b\"\nmaterial = \"wod\"\nshape = \"block\"\nposition = 3\n");
    EXPECT_EQ(message,
              "bad.toml:3:1: unknown key 'nme' in [shot]; did you mean 'name'? (valid: name, "
              "frames, fps, units, up, gravity, seed)\n"
              "bad.toml:4:7: 'fps' must be a number above 0 and below 10000, not 0\n"
              "bad.toml:6:12: 'friction' must be a number of at least 0, not -1\n"
              "bad.toml:9:12: no [material.wod] in the shot; did you mean 'wood'? (known: wood)\n"
              "bad.toml:10:9: no [shape.block] in the shot\n"
              "bad.toml:11:12: 'position' must be 3 numbers [x, y, z], not 3");
}

TEST(ShotErrors, APoseFileThatIsNotThereIsToldOnce)
{
    const std::string emitter =
        kBase + "[[emitter]]\nname = \"e\"\nshape = \"block\"\nmaterial = \"wood\"\ncount = 3\n";
    const test::Refusal refusal = test::refusalBy(
        [&] { parseShotText(emitter + "poses = \"no_such.poses\"\n", "bad.toml"); });
    EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
    EXPECT_EQ(refusal.message, "bad.toml:12:9: pose file 'no_such.poses' does not exist");
}

// The second message only hid the first, which knows what is wrong.
TEST(ShotErrors, AKeyReportedAsMisspeltIsNotReportedAgainAsMissing)
{
    const std::string shot = "[shot]\nname = \"s\"\n";
    const std::pair<std::string, int> shots[] = {
        {"sree = 1\n" + shot, 1},
        {"scree = 1\n[shto]\nname = \"s\"\n", 1},
        {kHead + "[materials.wood]\n[shapes.a]\nbox = {}\n[[body]]\nname = \"b\"\nshape = "
                 "\"a\"\nmaterial = \"wood\"\n",
         2},
        {kHead + "[shape.a]\nboks = {}\n", 1},
        {body("shap = \"block\"\n"), 1},
        {body("shape = \"block\"\nmotion = \"keyed\"\nkys = []\n"), 1},
        {kHead + "[[camera]]\neey = [1, 0, 0]\n", 1},
        {kHead + "[[camera]]\nfiles = \"a.glb\"\n", 1},
        {kBase + "[[force]]\ntipe = \"wind\"\nstrenght = 3\n", 2},
        {kBase + "[[pair]]\nof = [\"wood\", \"wood\"]\nfrction = 1\n", 1},
    };
    for (const auto& [text, slips] : shots) {
        const std::string message = messageOf(text);
        EXPECT_EQ(std::ranges::count(message, '\n') + 1, slips) << message;
        EXPECT_EQ(message.find("lacks"), std::string::npos) << message;
    }
}

TEST(ShotErrors, WhatFollowsFromADefaultInTheWrongPlaceIsNotReported)
{
    const std::string plane = kBase +
                              "[[body]]\nname = \"b\"\nmaterial = \"wood\"\nplane = { "
                              "normal = [0, 1, 0] }\n";
    for (const std::string& text :
         {plane + "motion = \"sttic\"\n", plane + "moton = \"static\"\n",
          body("shape = \"block\"\nmotion = \"keyd\"\nrelease = 1010\nkeys = [{ frame = 5, "
               "position = [0, 0, 0] }]\n"),
          kHead + "[shape.a]\nbox = {}\nmesh = { repair = \"shel\", thickness = 1 }\n"}) {
        const std::string message = messageOf(text);
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(ShotErrors, AValueReportedAsWrongIsNotReportedAgainAsMissing)
{
    EXPECT_EQ(messageOf(kHead + "[shape.a]\nbox = 3\n[material.wood]\n[[body]]\nname = \"b\"\n"
                                "material = 7\nshape = 8\n"),
              "bad.toml:5:7: 'box' must be a table, not 3\n"
              "bad.toml:9:12: 'material' must be text in quotes, not 7\n"
              "bad.toml:10:9: 'shape' must be text in quotes, not 8");
}

TEST(ShotErrors, AMissingShotFileIsMissingInput)
{
    const test::Refusal refusal = test::refusalBy([&] { parseShot("/no/such/shot.toml"); });
    EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
    EXPECT_EQ(refusal.message, "shot file '/no/such/shot.toml' does not exist");
}

TEST(ShotErrors, AMissingPoseFileAloneIsMissingInput)
{
    const test::Refusal refusal = test::refusalBy([&] {
        parseShotText(body("shape = \"block\"\nposes = \"none.poses\"\n"), "dir/bad.toml");
    });
    EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
    EXPECT_EQ(refusal.message, "dir/bad.toml:11:9: pose file 'dir/none.poses' does not exist");
}

TEST(ShotErrors, ProblemsOfAPoseFileAreLocatedInThatFile)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "b.poses") << "# x y z qw qx qy qz\n"
                                         "0 0 0 1 0 0 0\n"
                                         "0 0 0 1 0 0\n"
                                         "0 0 zero 1 0 0 0  # a word\n"
                                         "0 0 0  0 0 0 0\n"
                                         "0 inf 0 1 0 0 0\n";
    const std::string shot = (folder / "bad.toml").string();
    const std::string poses = (folder / "b.poses").string();
    const test::Refusal refusal = test::refusalBy(
        [&] { parseShotText(body("shape = \"block\"\nposes = \"b.poses\"\nmotion = 1\n"), shot); });
    EXPECT_EQ(
        refusal.message,
        shot + ":12:10: 'motion' must be one of \"dynamic\", \"static\", \"keyed\", not 1\n" +  //
            poses + ":3:1: the line has 6 numbers; expected 7: x y z qw qx qy qz\n" + poses +
            ":4:5: 'zero' is not a finite number\n" +  //
            poses + ":5:8: the orientation qw qx qy qz is zero\n" + poses +
            ":6:3: 'inf' is not a finite number");
}

// Its mark of UTF-8 was no finite number.
TEST(ShotErrors, FilesOfEditorsOnWindowsAreRead)
{
    const test::TemporaryFolder folder;
    const std::string mark = "\xef\xbb\xbf";
    for (const std::string first : {"# x y z qw qx qy qz\r\n", ""}) {
        writeFileBytes(folder / "b.poses", mark + first + "0 2 0 1 0 0 0\r\n1 2 0 1 0 0 0");
        std::string text = body("shape = \"block\"\nposes = \"b.poses\"\n");
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
            text.insert(at, "\r");
        const Shot shot = parseShotText(mark + text, (folder / "s.toml").string());
        ASSERT_EQ(shot.bodies.size(), 2u);
        EXPECT_EQ(shot.bodies[1].worldFromAsset.position, Vec3(1, 2, 0));
    }
}

TEST(ShotErrors, BadOverridesNameTheirOwnText)
{
    const std::string text = body("shape = \"block\"\n");
    const auto message = [&](const std::string& setting) { return messageOf(text, {setting}); };

    EXPECT_EQ(message("nonsense"),
              "--set nonsense: expected KEY=VALUE, for example solver.contact_iterations=20");
    EXPECT_EQ(message("material.wood.frction=0.3"),
              std::string("--set material.wood.frction=0.3: unknown key 'frction' in 'material'; "
                          "did you mean 'friction'? ") +
                  kMaterialKeys);
    EXPECT_EQ(message("material.wod.friction=0.3"),
              "--set material.wod.friction=0.3: no material 'wod' in the shot; did you mean "
              "'wood'? (known: wood)");
    EXPECT_EQ(message("body.c.position=[0,1,0]"),
              "--set body.c.position=[0,1,0]: no body 'c' in the shot (known: b)");
    EXPECT_EQ(message("material.wood.friction=-1"),
              "--set material.wood.friction=-1: 'friction' must be a number of at least 0, not -1");
    EXPECT_EQ(message("material.wood.friction=much"),
              "--set material.wood.friction=much: 'material.friction' must be a number of at least "
              "0, not much");
    EXPECT_EQ(message("solver.substeps.max="),
              "--set solver.substeps.max=: 'solver.substeps.max' must be a whole number from 1 to "
              "100000, not nothing");
    EXPECT_EQ(
        message("body.b=3"),
        "--set body.b=3: 'b' is a whole [body]; name one of its keys: name, shape, plane, "
        "material, motion, position, rotation, orientation, velocity, spin, mass, grid, "
        "poses, force, torque, group, collides, unmoved_by, start, visible, keys, interpolate, "
        "release, keyed_from");
    EXPECT_EQ(message("shot.fps.x=1"), "--set shot.fps.x=1: 'fps' has no keys of its own");
    EXPECT_EQ(message("shot.frames=end"),
              "--set shot.frames=end: 'frames' must be \"FIRST-LAST\", for example "
              "\"1001-1240\", not \"end\"");
}

TEST(ShotErrors, WhatAShotStandsOnCannotBeSet)
{
    for (const std::string setting : {"extends=\"x.toml\"", "extends=5", "extends.a=1"}) {
        EXPECT_EQ(
            messageOf(body("shape = \"block\"\n"), {setting}),
            "--set " + setting + ": 'extends' cannot be set: what a shot stands on is read before");
    }
}

TEST(ShotErrors, OverridesReachWhatHasNoNameByItsNumber)
{
    const std::string text = body("shape = \"block\"\n") +
                             "[[force]]\ntype = \"wind\"\nstrength = 1\ndirection = [1, 0, 0]\n"
                             "[[force]]\nname = \"draught\"\ntype = \"wind\"\nstrength = 1\n"
                             "direction = [1, 0, 0]\n";
    EXPECT_EQ(messageOf(text, {"force.0.strength=3"}), "");
    EXPECT_EQ(messageOf(text, {"force.draught.strength=3"}), "");
    EXPECT_EQ(messageOf(text, {"force.1.strength=3"}),
              "--set force.1.strength=3: no force '1' in the shot (known: 0, draught)");
}

TEST(ShotErrors, OverridesReplaceAWholeListOfKeys)
{
    const std::string text = body(
        "shape = \"block\"\nmotion = \"keyed\"\n"
        "keys = [{ frame = 1001, position = [0, 0, 0] }]\n");
    const Shot shot = parseShotText(
        text, "s.toml",
        {"body.b.keys=[{frame=1001,position=[0,5,0]},{frame=1010,position=[0,6,0]}]"});
    ASSERT_EQ(shot.bodies.size(), 1u);
    ASSERT_EQ(shot.bodies[0].keys.size(), 2u);
    EXPECT_EQ(messageOf(text, {"body.b.keys=7"}).substr(0, 22), "--set body.b.keys=7: '");
    EXPECT_EQ(messageOf(text, {"body=[]"}),
              "--set body=[]: 'body' is followed by a name and a key: body.NAME.KEY=VALUE");
}

TEST(ShotErrors, NamesTheSystemWillNotLookAtAreMissingInputWithTheirPlace)
{
    const std::string longName(300, 'n');
    const auto messageWith = [&](const std::string& text) -> std::string {
        const test::Refusal refusal = test::refusalBy([&] { parseShotText(text, "bad.toml"); });
        EXPECT_EQ(refusal.kind, ErrorKind::missingInput);
        return refusal.message;
    };
    EXPECT_EQ(messageWith(body("shape = \"block\"\nposes = \"" + longName + "\"\n")),
              "bad.toml:11:9: pose file '" + longName + "' cannot be reached: File name too long");
    EXPECT_EQ(
        messageWith(kHead + "[shape.a]\nfile = \"" + longName + ".obj\"\n"),
        "bad.toml:5:8: mesh file '" + longName + ".obj' cannot be reached: File name too long");
    EXPECT_EQ(
        messageWith(kBase + "[[import]]\nfile = \"" + longName + ".glb\"\nmaterial = \"wood\"\n"),
        "bad.toml:8:8: '" + longName + ".glb' cannot be reached: File name too long");
    EXPECT_EQ(messageWith("extends = \"" + longName + "\"\n" + kHead),
              "bad.toml:1:11: shot file '" + longName + "' cannot be reached: File name too long");
}

TEST(ShotErrors, AFolderAsBaseIsToldWithItsPlace)
{
    EXPECT_EQ(messageOf("extends = \".\"\n" + kHead),
              "bad.toml:1:11: shot file '.' is a folder without a shot.toml: name the .toml file "
              "in it");
}

TEST(ShotErrors, AShotMayBeAFolderWithItsShotToml)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "shot.toml") << kBase << "[[body]]\nname = \"b\"\nmaterial = "
                                        << "\"wood\"\nshape = \"block\"\n";
    EXPECT_EQ(parseShot(folder.path().string()).bodies.size(), 1u);
}

}  // namespace
}  // namespace scree
