// Which way the arrows point: includes are read and held against the plan of the rooms.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/support.h"

namespace scree::test {
namespace {

struct Include {
    std::string file;  // relative to the source tree
    std::string path;  // as written between quotes or brackets
    bool isOurs;
};

std::vector<Include> includesOf(const std::string& room)
{
    static const std::regex pattern("^\\s*#include\\s+([\"<])([^\">]+)[\">]");
    std::vector<Include> includes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(sourceFile(room))) {
        const std::string ending = entry.path().extension();
        if (ending != ".h" && ending != ".cpp") continue;
        std::ifstream file(entry.path());
        std::smatch match;
        for (std::string line; std::getline(file, line);) {
            if (!std::regex_search(line, match, pattern)) continue;
            includes.push_back({std::filesystem::relative(entry.path(), sourceFile(".")),
                                match[2].str(), match[1].str() == "\""});
        }
    }
    return includes;
}

TEST(Rooms, CoreKnowsNobodyAndInputOutputAndRenderKnowOnlyCore)
{
    const std::map<std::string, std::set<std::string>> allowed = {
        {"core", {"core"}}, {"io", {"core", "io"}}, {"render", {"core", "render"}}};
    for (const auto& [room, known] : allowed) {
        const std::vector<Include> includes = includesOf(room);
        EXPECT_GT(includes.size(), 50u) << room;
        for (const Include& include : includes) {
            if (!include.isOurs) continue;
            const std::string target = include.path.substr(0, include.path.find('/'));
            EXPECT_TRUE(known.count(target)) << include.file << " includes " << include.path;
        }
    }
}

TEST(Rooms, InsideCoreArrowsPointFromDynamicsDownToBase)
{
    // A folder knows itself and those before it. A step report names bodies, so diagnostics know
    // the scene. How things look is the last to know: nothing that moves depends on it.
    const std::vector<std::string> order = {"base",      "math",        "geometry", "scene",
                                            "collision", "diagnostics", "dynamics", "picture"};
    const auto rank = [&](const std::string& folder) {
        return std::find(order.begin(), order.end(), folder) - order.begin();
    };
    for (const Include& include : includesOf("core")) {
        if (!include.isOurs) continue;
        const auto folderOf = [](const std::string& path) {
            const std::size_t start = path.find('/') + 1;
            return path.substr(start, path.find('/', start) - start);
        };
        ASSERT_LT(rank(folderOf(include.file)), std::ssize(order)) << include.file;
        EXPECT_LE(rank(folderOf(include.path)), rank(folderOf(include.file)))
            << include.file << " includes " << include.path;
    }
}

// The paper's method is the oracle of the other: it must not lean on what it is held against.
TEST(Rooms, OnlyTheStepperKnowsTheFolderOfMethodScree)
{
    int known = 0;
    for (const Include& include : includesOf("core")) {
        if (include.path.rfind("core/dynamics/gaps/", 0) != 0) continue;
        ++known;
        EXPECT_TRUE(include.file.rfind("core/dynamics/gaps/", 0) == 0 ||
                    include.file == "core/dynamics/stepper.cpp")
            << include.file << " includes " << include.path;
    }
    EXPECT_GT(known, 100);
}

TEST(Rooms, GuestLibrariesStayInTheSourcesThatInviteThem)
{
    const std::map<std::string, std::set<std::string>> invited = {
        {"openvdb/",
         {"core/geometry/level_set_build.cpp", "core/geometry/level_set_remesh.cpp",
          "core/geometry/level_set_surface.cpp"}},
        {"embree3/", {"core/geometry/surface_rays.cpp", "render/ray_tracer.cpp"}},
        {"tbb/", {"core/base/parallel.cpp"}},
        {"assimp/", {"io/mesh_import_assimp.cpp", "io/mesh_import_nodes.cpp"}},
        {"toml++/", {"io/shot_parser.cpp"}},
        {"GL/", {"render/rasterizer.cpp", "render/gl_resources.cpp"}},
        {"png.h", {"render/png_writer.cpp"}},
        {"libdeflate.h", {"render/png_writer.cpp"}}};
    std::map<std::string, int> seen;
    for (const std::string room : {"core", "io", "render", "tools"}) {
        for (const Include& include : includesOf(room)) {
            for (const auto& [library, files] : invited) {
                if (include.path.rfind(library, 0) != 0) continue;
                ++seen[library];
                EXPECT_TRUE(files.count(include.file))
                    << include.file << " includes " << include.path;
            }
        }
    }
    EXPECT_EQ(seen.size(), invited.size());
}

// A place on a rim was led by an arc tangent of the C library, which has other last bits on other
// processors.
TEST(Rooms, WhatMovesBodiesCallsNoFunctionWhoseBitsDependOnTheProcessor)
{
    const std::regex call(
        "std::(a?(sin|cos|tan)h?|atan2|exp|log|pow|cbrt|hypot)\\b|AngleAxis|slerp");
    int lines = 0;
    for (const std::string folder : {"math", "geometry", "collision", "scene", "dynamics"}) {
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(sourceFile("core/" + folder))) {
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line); ++lines)
                EXPECT_FALSE(std::regex_search(line, call)) << entry.path() << ": " << line;
        }
    }
    EXPECT_GT(lines, 5000);
}

}  // namespace
}  // namespace scree::test
