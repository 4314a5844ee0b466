// Which objects an OBJ file has, and what they are called.
#include "io/obj_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/mesh_import.h"
#include "tests/support/support.h"

namespace scree {
namespace {

/// Names of the nodes of an OBJ file, and how many triangles each has: "Cube 1".
std::vector<std::string> nodesOf(const std::string& text)
{
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + text);
    std::vector<std::string> nodes;
    for (const ImportedNode& node : importFile(folder / "x.obj").nodes) {
        nodes.push_back(node.name + " " + std::to_string(node.mesh.triangles.cols()));
    }
    return nodes;
}

using Names = std::vector<std::string>;

TEST(ObjNames, ObjectsOfOneNameAreTwo)
{
    EXPECT_EQ(nodesOf("o Cube\nf 1 2 3\no Cube\nf 1 2 4\nf 1 3 4\n"),
              (Names{"Cube 1", "Cube.001 2"}));
    EXPECT_EQ(nodesOf("o A b\r\nf 1 2 3\r\no A b\r\nf 1 2 4\r\no A b\r\nf 1 3 4"),
              (Names{"A b 1", "A b.001 1", "A b.002 1"}));
}

TEST(ObjNames, AnotherObjectsNameIsNotTaken)
{
    EXPECT_EQ(nodesOf("o Cube\nf 1 2 3\no Cube\nf 1 2 4\no Cube.001\nf 1 3 4\n"),
              (Names{"Cube 1", "Cube.002 1", "Cube.001 1"}));
}

TEST(ObjNames, WhatHasNoFacesIsNoObject)
{
    EXPECT_EQ(nodesOf("o Cube\no Cube\nf 1 2 3\no Cube\nl 1 2\n"), (Names{"Cube 1"}));
}

TEST(ObjNames, GroupsDoNotCutObjects)
{
    EXPECT_EQ(nodesOf("o Chair\ng seat\nf 1 2 3\ng leg\nf 1 2 4\no Table\ng leg\nf 1 3 4\n"),
              (Names{"Chair 2", "Table 1"}));
}

TEST(ObjNames, WithoutObjectsGroupsAreNodes)
{
    EXPECT_EQ(nodesOf("g seat\nf 1 2 3\ng leg\nf 1 2 4\n"), (Names{"seat 1", "leg 1"}));
    EXPECT_EQ(nodesOf("o scene\ng seat\nf 1 2 3\ng leg\nf 1 2 4\n"), (Names{"seat 1", "leg 1"}));
}

TEST(ObjNames, AFileThatIsReadRightIsNotCopied)
{
    EXPECT_EQ(textWithObjNames("o Cube\nv 0 0 0\nf 1 1 1\n"), std::nullopt);
    EXPECT_EQ(textWithObjNames("o A\nf 1 1 1\no B\nf 1 1 1\n"), std::nullopt);
}

}  // namespace
}  // namespace scree
