// What a well-formed shot means: units, defaults, overrides, copies, the resolved text,
// explanations.
#include "io/shot_parser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "io/nearest_word.h"
#include "io/shot_schema.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

const std::string kHead = "scree = 1\n[shot]\nname = \"s\"\n";
const std::string kBase = kHead + "[material.wood]\n[shape.block]\nbox = {}\n";

std::string body(const std::string& lines)
{
    return kBase + "[[body]]\nname = \"b\"\nmaterial = \"wood\"\nshape = \"block\"\n" + lines;
}

/// Everything a simulation could notice, as text.
std::string fingerprint(const Shot& shot)
{
    std::string text = shot.resolvedText;
    const auto append = [&](double number) { text += std::to_string(number) + " "; };
    for (const ShotBody& one : shot.bodies) {
        text += "\n" + one.name + " " + one.shape.value_or("plane") + " " + one.material + " ";
        for (int k = 0; k < 3; ++k) append(one.worldFromAsset.position[k]);
        for (int k = 0; k < 4; ++k) append(one.worldFromAsset.orientation.coeffs()[k]);
        for (int k = 0; k < 3; ++k) append(one.velocity[k] + 1000.0 * one.angularVelocity[k]);
        append(one.mass.value_or(-1.0));
        if (one.plane) append(one.plane->point.sum() + 10.0 * one.plane->normal.x());
    }
    return text;
}

TEST(ShotParser, DefaultsOfTheFileAreThoseOfTheSolver)
{
    const StepSettings ours, parsed = parseShotText(kHead, "s.toml").settings;
    EXPECT_EQ(parsed.gravity, ours.gravity);
    EXPECT_EQ(parsed.seed, ours.seed);
    EXPECT_EQ(parsed.collisionIterations, ours.collisionIterations);
    EXPECT_EQ(parsed.collisionPairImpulses, ours.collisionPairImpulses);
    EXPECT_EQ(parsed.contactIterations, ours.contactIterations);
    EXPECT_EQ(parsed.levelIterations, ours.levelIterations);
    EXPECT_EQ(parsed.pairImpulses, ours.pairImpulses);
    EXPECT_EQ(parsed.shockPropagation, ours.shockPropagation);
    EXPECT_EQ(parsed.shockPairImpulses, ours.shockPairImpulses);
    EXPECT_EQ(parsed.pushOut, ours.pushOut);
    EXPECT_EQ(parsed.pushOutLevelIterations, ours.pushOutLevelIterations);
    EXPECT_EQ(parsed.pushOutPairImpulses, ours.pushOutPairImpulses);
    EXPECT_EQ(parsed.orientation, ours.orientation);
    EXPECT_EQ(parsed.substeps.min, ours.substeps.min);
    EXPECT_EQ(parsed.substeps.max, ours.substeps.max);
    EXPECT_EQ(parsed.substeps.safety, ours.substeps.safety);
    EXPECT_EQ(parsed.maximumSpinPerStep, ours.maximumSpinPerStep);
    EXPECT_EQ(parsed.hoverLimit, ours.hoverLimit);
}

TEST(ShotParser, DefaultsOfShapesAndMaterialsAreThoseOfTheirStructs)
{
    const Shot shot = parseShotText(kHead +
                                        "[material.m]\n[shape.a]\ntorus = {}\n[shape.b]\n"
                                        "box = {}\n[shape.c]\nsphere = {}\n[shape.d]\n"
                                        "cylinder = {}\n[shape.e]\ncapsule = {}\n",
                                    "s.toml");
    const Material material;
    EXPECT_EQ(shot.materials[0].material.density, material.density);
    EXPECT_EQ(shot.materials[0].material.friction, material.friction);
    EXPECT_EQ(shot.materials[0].material.restitution, material.restitution);
    EXPECT_EQ(shot.materials[0].color, ShotMaterial().color);
    EXPECT_EQ(shot.materials[0].roughness, ShotMaterial().roughness);

    const auto& torus = std::get<TorusSpec>(shot.shapes[0].source);
    EXPECT_EQ(torus.major, TorusSpec().major);
    EXPECT_EQ(torus.minor, TorusSpec().minor);
    EXPECT_EQ(torus.segments, TorusSpec().segments);
    EXPECT_EQ(std::get<BoxSpec>(shot.shapes[1].source).size, BoxSpec().size);
    EXPECT_EQ(std::get<BoxSpec>(shot.shapes[1].source).segments, BoxSpec().segments);
    EXPECT_EQ(std::get<SphereSpec>(shot.shapes[2].source).subdivisions, SphereSpec().subdivisions);
    EXPECT_EQ(std::get<CylinderSpec>(shot.shapes[3].source).sectors, CylinderSpec().sectors);
    EXPECT_EQ(std::get<CapsuleSpec>(shot.shapes[4].source).rings, CapsuleSpec().rings);
}

TEST(ShotParser, SolverKeysReachTheSettingsOfTheSameName)
{
    const StepSettings settings =
        parseShotText(
            kHead +
                "[solver]\nmethod = \"paper\"\ncollision_iterations = 11\n"
                "collision_pair_impulses = 12\ncontact_iterations = 13\n"
                "level_iterations = 14\npair_impulses = 15\nshock_propagation = false\n"
                "shock_pair_impulses = 16\npush_out = false\n"
                "push_out_level_iterations = 17\npush_out_pair_impulses = 18\n"
                "orientation = \"euler\"\nsubsteps = { min = 19, max = 20, safety = 0.25 }\n"
                "maximum_spin = 90\nhover = 0.001\n",
            "s.toml")
            .settings;
    EXPECT_EQ(settings.collisionIterations, 11);
    EXPECT_EQ(settings.collisionPairImpulses, 12);
    EXPECT_EQ(settings.contactIterations, 13);
    EXPECT_EQ(settings.levelIterations, 14);
    EXPECT_EQ(settings.pairImpulses, 15);
    EXPECT_FALSE(settings.shockPropagation);
    EXPECT_EQ(settings.shockPairImpulses, 16);
    EXPECT_FALSE(settings.pushOut);
    EXPECT_EQ(settings.pushOutLevelIterations, 17);
    EXPECT_EQ(settings.pushOutPairImpulses, 18);
    EXPECT_EQ(settings.orientation, OrientationUpdate::euler);
    EXPECT_EQ(settings.substeps.min, 19);
    EXPECT_EQ(settings.substeps.max, 20);
    EXPECT_EQ(settings.substeps.safety, 0.25);
    EXPECT_DOUBLE_EQ(settings.maximumSpinPerStep, std::acos(-1.0) / 2.0);
    EXPECT_EQ(settings.hoverLimit, 0.001);
}

TEST(ShotParser, AKeyThatTheMethodDoesNotReadIsToldOfWhereItStands)
{
    const auto warningsOf = [](const std::string& solver) {
        return parseShotText(kHead + "[solver]\n" + solver, "s.toml").warnings;
    };
    const std::string ofPaper = "contact_iterations = 50\nhover = 0.001\n",
                      ofScree = "sleep = false\n";
    ASSERT_EQ(warningsOf(ofPaper).size(), 2u);
    EXPECT_EQ(warningsOf(ofPaper)[0],
              "s.toml:5:22: 'contact_iterations' changes nothing: only method \"paper\" reads it, "
              "and this shot has method \"scree\"");
    EXPECT_EQ(warningsOf("method = \"paper\"\n" + ofScree).size(), 1u);
    EXPECT_TRUE(warningsOf("method = \"paper\"\n" + ofPaper).empty());
    EXPECT_TRUE(warningsOf(ofScree).empty());
    // A resolved shot holds all keys.
    for (const char* method : {"method = \"paper\"\n", ""}) {
        const Shot shot = parseShotText(kHead + "[solver]\n" + method, "s.toml");
        EXPECT_TRUE(parseShotText(shot.resolvedText, "s.toml").warnings.empty());
    }
}

// Meant as a number of frames, it was simulated as one, and nothing was said.
TEST(ShotParser, ASingleFrameIsToldToBeOne)
{
    const auto warningsOf = [](const std::string& frames) {
        return parseShotText("scree = 1\n[shot]\nname = \"s\"\nframes = \"" + frames + "\"\n",
                             "s.toml")
            .warnings;
    };
    ASSERT_EQ(warningsOf("24").size(), 1u);
    EXPECT_EQ(warningsOf("24")[0],
              "s.toml:4:10: 'frames' is the one frame 24, not so many: \"FIRST-LAST\" is a range");
    EXPECT_TRUE(warningsOf("24-24").empty());
    EXPECT_TRUE(warningsOf("-3-24").empty());
}

TEST(ShotParser, LengthsBecomeMetresButGravityDoesNotChange)
{
    const Shot shot = parseShotText(
        kHead +
            "units = \"cm\"\n[material.wood]\n[shape.block]\nbox = { size = [100, 200, 300] }\n"
            "sdf = { voxel = 2 }\n[[body]]\nname = \"b\"\nmaterial = \"wood\"\nshape = \"block\"\n"
            "position = [50, 0, -50]\nvelocity = [0, 100, 0]\nspin = [0, 180, 0]\nmass = 2\n"
            "[[body]]\nname = \"ground\"\nmaterial = \"wood\"\nmotion = \"static\"\n"
            "plane = { point = [0, 10, 0], normal = [0, 2, 0] }\n"
            "[[camera]]\neye = [100, 0, 0]\n",
        "s.toml");
    EXPECT_EQ(shot.metresPerUnit, 0.01);
    EXPECT_TRUE(std::get<BoxSpec>(shot.shapes[0].source).size.isApprox(Vec3(1.0, 2.0, 3.0)));
    EXPECT_DOUBLE_EQ(*shot.shapes[0].settings.voxel, 0.02);
    EXPECT_TRUE(shot.bodies[0].worldFromAsset.position.isApprox(Vec3(0.5, 0.0, -0.5)));
    EXPECT_TRUE(shot.bodies[0].velocity.isApprox(Vec3(0.0, 1.0, 0.0)));
    EXPECT_TRUE(shot.bodies[0].angularVelocity.isApprox(Vec3(0.0, std::acos(-1.0), 0.0)));
    EXPECT_EQ(shot.bodies[0].mass, 2.0);
    EXPECT_TRUE(shot.bodies[1].plane->point.isApprox(Vec3(0.0, 0.1, 0.0)));
    EXPECT_EQ(shot.bodies[1].plane->normal, Vec3(0.0, 1.0, 0.0));
    EXPECT_TRUE(shot.cameras[0].eye.isApprox(Vec3(1.0, 0.0, 0.0)));
    EXPECT_EQ(shot.settings.gravity, Vec3(0.0, -9.81, 0.0));
}

TEST(ShotParser, LeverArmsOfRollingFrictionAreLengthsAndRawCoefficientsAreNot)
{
    const Shot shot = parseShotText(kHead +
                                        "units = \"cm\"\n[material.tyre]\nrolling_friction = 2\n"
                                        "spinning_friction_raw = 3\n[material.ice]\n",
                                    "s.toml");
    const RollingFriction& tyre = shot.materials[0].material.rolling;
    EXPECT_DOUBLE_EQ(tyre.rolling, 0.02);
    EXPECT_EQ(tyre.rawRolling, 0.0);
    EXPECT_EQ(tyre.spinning, 0.0);
    EXPECT_EQ(tyre.rawSpinning, 3.0);
    EXPECT_TRUE(shot.materials[1].material.rolling.isNone());
}

TEST(ShotParser, OnlyAShapeThatAsksForItCollidesAsItsExactSolid)
{
    const Shot shot = parseShotText(
        kHead + "[shape.a]\nsphere = {}\n[shape.b]\ncylinder = {}\ncollide = \"exact\"\n",
        "s.toml");
    EXPECT_FALSE(shot.shapes[0].isExact);
    EXPECT_TRUE(shot.shapes[1].isExact);
}

TEST(ShotParser, UpTurnsOnlyTheDefaultGravity)
{
    const Shot byDefault = parseShotText(kHead + "up = \"+z\"\n", "s.toml");
    EXPECT_TRUE(byDefault.zUp);
    EXPECT_EQ(byDefault.settings.gravity, Vec3(0.0, 0.0, -9.81));
    const Shot given = parseShotText(kHead + "up = \"+z\"\ngravity = [1, 2, 3]\n", "s.toml");
    EXPECT_EQ(given.settings.gravity, Vec3(1.0, 2.0, 3.0));
}

TEST(ShotParser, RotationTurnsAboutXFirstAndZLast)
{
    const Shot shot = parseShotText(body("rotation = [90, 0, 90]\n"), "s.toml");
    // About x, y goes to z, where the turn about z leaves it; x goes to y.
    const Quat q = shot.bodies[0].worldFromAsset.orientation;
    EXPECT_TRUE((q * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-14));
    EXPECT_TRUE((q * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-14));
}

TEST(ShotParser, OrientationIsWrittenWxyzAndNormalised)
{
    const Shot shot = parseShotText(body("orientation = [3, 0, 4, 0]\n"), "s.toml");
    const Quat q = shot.bodies[0].worldFromAsset.orientation;
    EXPECT_DOUBLE_EQ(q.w(), 0.6);
    EXPECT_DOUBLE_EQ(q.y(), 0.8);
}

TEST(ShotParser, GridCopiesStandAboutThePositionAndCountXFirst)
{
    const Shot shot = parseShotText(
        body("position = [10, 5, 0]\ngrid = { count = [3, 1, 2], spacing = [4, 0, 2] }\n"),
        "s.toml");
    ASSERT_EQ(shot.bodies.size(), 6u);
    EXPECT_EQ(shot.bodies[0].name, "b_0000");
    EXPECT_EQ(shot.bodies[0].worldFromAsset.position, Vec3(6.0, 5.0, -1.0));
    EXPECT_EQ(shot.bodies[1].worldFromAsset.position, Vec3(10.0, 5.0, -1.0));
    EXPECT_EQ(shot.bodies[5].name, "b_0005");
    EXPECT_EQ(shot.bodies[5].worldFromAsset.position, Vec3(14.0, 5.0, 1.0));
}

TEST(ShotParser, PoseFilesAreFoundBesideTheShot)
{
    const test::TemporaryFolder folder;
    std::ofstream(folder / "b.poses") << "# two\n1 2 3  1 0 0 0\n\n-1 +2.5 3e0\t0 0 2 0 # turned\n";
    const Shot shot = parseShotText(body("poses = \"b.poses\"\n"), (folder / "s.toml").string());
    ASSERT_EQ(shot.bodies.size(), 2u);
    EXPECT_EQ(shot.bodies[1].name, "b_0001");
    EXPECT_EQ(shot.bodies[1].worldFromAsset.position, Vec3(-1.0, 2.5, 3.0));
    EXPECT_EQ(shot.bodies[1].worldFromAsset.orientation.y(), 1.0);
}

TEST(ShotParser, MaterialsShapesAndBodiesKeepTheOrderOfTheFile)
{
    const Shot shot = parseShotText(
        kHead + "[material.z]\n[shape.y]\nbox = {}\n[material.a]\n[shape.b]\nsphere = {}\n",
        "s.toml");
    EXPECT_EQ(shot.materials[0].material.name, "z");
    EXPECT_EQ(shot.materials[1].material.name, "a");
    EXPECT_EQ(shot.shapes[0].name, "y");
    EXPECT_EQ(shot.shapes[1].name, "b");
    EXPECT_EQ(shot.shapes[1].location.line, 8);
}

TEST(ShotParser, OverridesReplaceAndAddValues)
{
    const Shot shot = parseShotText(
        body("position = [0, 0, 0]\n"), "s.toml",
        {"material.wood.friction=0.25", "solver.contact_iterations=20", "shot.frames=1001-1010",
         "shot.name=\"other\"", "body.b.position=[0, 1, 0]", "solver.substeps.max = 99",
         "shape.block.sdf.resolution=100", "output.export=[\"abc\"]", "shot.units=cm"});
    EXPECT_EQ(shot.materials[0].material.friction, 0.25);
    EXPECT_EQ(shot.settings.contactIterations, 20);
    EXPECT_EQ(shot.lastFrame, 1010);
    EXPECT_EQ(shot.name, "other");
    EXPECT_EQ(shot.bodies[0].worldFromAsset.position, Vec3(0.0, 0.01, 0.0));
    EXPECT_EQ(shot.settings.substeps.max, 99);
    EXPECT_EQ(shot.shapes[0].settings.resolution, 100);
    EXPECT_EQ(shot.output.exports, std::vector<std::string>{"abc"});
}

TEST(ShotParser, AnOverrideMendsWhatTheFileSaysWrong)
{
    EXPECT_EQ(parseShotText(kHead + "fps = -1\n", "s.toml", {"shot.fps=30"}).framesPerSecond, 30.0);
}

TEST(ShotParser, ResolvedTextGivesTheSameShotAndTheSameText)
{
    const std::string rich =
        kHead +
        "units = \"in\"\nseed = 9\n[solver]\nhover = 1e-5\nsubsteps = { max = 7 }\n"
        "[material.steel]\ndensity = 123456789012345678901.0\nfriction = 0.1\n[material.Wood]\n"
        "[shape.ring]\ntorus = { major = 2 }\nscale = [1, 2.5, 1]\nedge_samples = false\n"
        "[shape.block]\nbox = {}\nsdf = { resolution = 64 }\n[shape.asset]\nfile = \"a "
        "\\\"b\\\".obj\"\n"
        "[[body]]\nname = \"g\"\nplane = { normal = [0.1, 1, 0] }\nmaterial = \"Wood\"\n"
        "motion = \"static\"\n"
        "[[body]]\nname = \"b\"\nshape = \"block\"\nmaterial = \"steel\"\nrotation = [10, 20, 30]\n"
        "spin = [1, 2, 3]\nmass = 0.3\ngrid = { count = [2, 2, 1], spacing = [1.1, 1, 0] }\n"
        "[[body]]\nname = \"c\"\nshape = \"ring\"\nmaterial = \"steel\"\n"
        "orientation = [0.1, 0.7, 0.3, 0.2]\n"
        "[[camera]]\neye = [1, 2, 3]\n[output]\nexport = [\"abc\", \"obj\"]\n";
    const Shot shot =
        parseShotText(rich, "s.toml", {"shot.fps=25", "material.steel.restitution=0.1"});
    const Shot again = parseShotText(shot.resolvedText, "s.toml");
    EXPECT_EQ(fingerprint(again), fingerprint(shot));
    EXPECT_EQ(again.framesPerSecond, 25.0);
    EXPECT_EQ(again.settings.hoverLimit, 1e-5);
    EXPECT_EQ(again.shapes[0].settings.edgeSamples, false);
    EXPECT_EQ(std::get<FileSpec>(again.shapes[2].source).path, "a \"b\".obj");
    EXPECT_EQ(again.materials[0].material.density, 123456789012345678901.0);
}

TEST(ShotParser, ResolvedTextWritesEveryDefault)
{
    const std::string text = parseShotText(body(""), "s.toml").resolvedText;
    for (const char* line :
         {"frames = \"1001-1240\"\n", "gravity = [0.0, -9.81, 0.0]\n", "contact_iterations = 10\n",
          "substeps = { min = 1, max = 256, safety = 0.5 }\n", "density = 1000.0\n",
          "box = { size = [1.0, 1.0, 1.0], segments = [2, 2, 2] }\n", "scale = 1.0\n",
          "motion = \"dynamic\"\n", "rotation = [0.0, 0.0, 0.0]\n", "size = [1280, 720]\n",
          "export = []\n"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line << "is not in\n" << text;
    }
}

TEST(ShotSchema, EveryKeyIsExplained)
{
    for (const ShotKey& key : shotKeys()) {
        const std::string text = explainKey(key.path);
        EXPECT_EQ(text.rfind(std::string(key.path) + "\n", 0), 0u) << text;
        EXPECT_GT(std::string(key.help).size(), 10u) << key.path;
    }
}

TEST(ShotSchema, ExplanationsTellTypeRangeUnitDefaultAndMeaning)
{
    const std::string text = explainKey("solver.contact_iterations");
    EXPECT_NE(text.find("a whole number from 0 to 1000 [sweeps]; default 10"), std::string::npos);
    EXPECT_NE(text.find("weight does not travel down"), std::string::npos);
    EXPECT_EQ(explainKey("contact_iterations"), text);
    EXPECT_EQ(explainKey("material.wood.friction"), explainKey("material.friction"));
    EXPECT_EQ(explainKey("material.mesh.friction"), explainKey("material.friction"));
    EXPECT_NE(explainKey("solver.method").find("scree"), std::string::npos);
    EXPECT_NE(explainKey("solver.substeps").find("Keys: min, max, safety."), std::string::npos);
}

TEST(ShotSchema, AnUnknownKeyIsAnsweredWithTheNearest)
{
    const auto message = [](const std::string& key) {
        const test::Refusal refusal = test::refusalBy([&] { explainKey(key); });
        EXPECT_EQ(refusal.kind, ErrorKind::usage);
        return refusal.message;
    };
    EXPECT_EQ(message("solver.contact_iteration"),
              "no key 'solver.contact_iteration' in shot files; did you mean "
              "'solver.contact_iterations'?");
    // "Did you mean 'fov'?" was no answer to who looks for a key of a body.
    EXPECT_EQ(message("pair.bounciness"),
              "no key 'pair.bounciness' in shot files (valid: of, friction, restitution)");
    EXPECT_EQ(message("frictoin"), "no key 'frictoin' in shot files; did you mean 'friction'?");
    EXPECT_EQ(message("qqqqqqqqqqqq"),
              "no key 'qqqqqqqqqqqq' in shot files; the file's tables are: scree, extends, shot, "
              "solver, start, material, shape, body, force, pair, import, emitter, camera, render, "
              "output");
}

TEST(NearestWord, ForgivesSlipsButNotOtherWords)
{
    const std::vector<std::string> words = {"density", "friction", "restitution"};
    EXPECT_EQ(nearestWord("fricton", words), "friction");
    EXPECT_EQ(nearestWord("Friction", words), "friction");
    EXPECT_EQ(nearestWord("firction", words), "friction");
    EXPECT_EQ(nearestWord("desnity", words), "density");
    EXPECT_EQ(nearestWord("colour", words), "");
    EXPECT_EQ(nearestWord("", words), "");
}

TEST(NearestWord, KnowsWhatOtherProgramsCallIt)
{
    EXPECT_EQ(didYouMean("angular_velocity", {"velocity", "spin"}), "; did you mean 'spin'?");
    EXPECT_EQ(didYouMean("Bounciness", {"density", "restitution"}),
              "; did you mean 'restitution'?");
    EXPECT_EQ(didYouMean("kinematic", {"dynamic", "static", "keyed"}), "; did you mean 'keyed'?");
    EXPECT_EQ(didYouMean("bounciness", {"density", "friction"}), "");
}

}  // namespace
}  // namespace scree
