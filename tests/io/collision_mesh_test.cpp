// shape.collision: one mesh is drawn, another collides.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "io/build_world.h"
#include "io/shot_parser.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

/// Writes the surface of a cube of edge 2 about the origin, without its lid if it is open.
void writeCube(const std::filesystem::path& path, bool isOpen)
{
    std::ofstream file(path);
    for (int i = 0; i < 8; ++i) {
        file << "v " << (i & 1 ? 1 : -1) << " " << (i & 2 ? 1 : -1) << " " << (i & 4 ? 1 : -1)
             << "\n";
    }
    file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 1 5 7 3\nf 2 4 8 6\n";
    if (!isOpen) file << "f 3 7 8 4\n";
}

class CollisionMesh : public testing::Test {
protected:
    CollisionMesh()
    {
        writeCube(folder / "open.obj", true);
        writeCube(folder / "closed.obj", false);
    }

    std::string textWith(const std::string& shapeLines) const
    {
        return "scree = 1\n[shot]\nname = \"s\"\nframes = \"1-2\"\nunits = \"cm\"\n"
               "[material.m]\ndensity = 1000\n[shape.box]\n" +
               shapeLines + "[[body]]\nname = \"b\"\nshape = \"box\"\nmaterial = \"m\"\n";
    }

    Shot parse(const std::string& shapeLines) const
    {
        return parseShotText(textWith(shapeLines), (folder / "s.toml").string());
    }

    std::string refusalOf(const std::string& shapeLines) const
    {
        return test::refusalBy([&] { buildWorld(parse(shapeLines)); }).message;
    }

    test::TemporaryFolder folder;
};

const std::string kBoth = "file = \"open.obj\"\ncollision = { file = \"closed.obj\" }\nscale = 3\n";

TEST_F(CollisionMesh, IsWhatHasMassWhileTheOtherIsExported)
{
    const Shot shot = parse(kBoth);
    const World world = buildWorld(shot);
    // Six centimetres of water, cubed.
    EXPECT_NEAR(1.0 / world.mass[0].inverseMass, 0.216, 1e-9);
    const SceneDescription scene = describeScene(shot, world, 1.0);
    EXPECT_EQ(scene.meshes[0].triangles.cols(), 10) << "five sides are drawn";
    EXPECT_NEAR(scene.meshes[0].points.maxCoeff(), 3.0, 1e-6) << "in the shot's unit, scaled";
    const ShapeRepairs& repairs = world.shapeOf(0).repairs;
    EXPECT_TRUE(repairs.hasCollisionMesh);
    // The lid is missing in the drawn mesh; its middle is farthest from the rim.
    EXPECT_NEAR(repairs.drawnToColliding.distance, 0.03, 0.001);
    EXPECT_FALSE(repairs.drawnToColliding.isOnFirst);
    EXPECT_NEAR(repairs.drawnToColliding.place.y(), 0.03, 1e-6);
}

TEST_F(CollisionMesh, IsAmongTheInputsOfATake)
{
    const Shot shot = parse(kBoth);
    const World world = buildWorld(shot);
    {
        TakeWriter take(folder / "take", shot, world, "1.2.3", ExistingTake::refuse);
    }
    const TakeInfo info = TakeReader(folder / "take").info();
    ASSERT_EQ(info.inputs.size(), 2u);
    EXPECT_EQ(info.inputs[0].path, (folder / "open.obj").string());
    EXPECT_EQ(info.inputs[1].path, (folder / "closed.obj").string());
}

TEST_F(CollisionMesh, OfAnotherFolderIsFoundBesideTheShotThatNamesIt)
{
    std::ofstream(folder / "base.toml") << textWith(kBoth);
    std::filesystem::create_directory(folder / "inner");
    const std::string path = (folder / "inner/s.toml").string();
    const Shot shot =
        parseShotText("scree = 1\nextends = \"../base.toml\"\n[shot]\nname = \"t\"\n", path);
    ASSERT_TRUE(shot.shapes[0].collision);
    EXPECT_TRUE(std::filesystem::equivalent(shot.shapes[0].collision->path, folder / "closed.obj"));
    const Shot again = parseShotText(shot.resolvedText, path);
    EXPECT_EQ(again.shapes[0].collision->path, shot.shapes[0].collision->path);
}

TEST_F(CollisionMesh, IsHeldToTheSameRulesAsAnyOther)
{
    EXPECT_NE(refusalOf("file = \"closed.obj\"\ncollision = { file = \"open.obj\" }\n")
                  .find("not a closed"),
              std::string::npos);
    EXPECT_NE(refusalOf("file = \"closed.obj\"\ncollision = { file = \"none.obj\" }\n")
                  .find("none.obj' does not exist"),
              std::string::npos);
    EXPECT_NE(refusalOf("box = {}\ncollide = \"exact\"\ncollision = { file = \"closed.obj\" }\n")
                  .find("a shape that collides as \"exact\" has no mesh to collide as"),
              std::string::npos);
    EXPECT_NE(refusalOf("file = \"closed.obj\"\ncollision = { fiel = \"open.obj\" }\n")
                  .find("did you mean 'file'"),
              std::string::npos);
}

}  // namespace
}  // namespace scree
