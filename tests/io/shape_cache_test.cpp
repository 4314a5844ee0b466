// Fields and solids that come back from the disk, and files that must not.
#include "io/shape_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "core/base/random.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "io/file_bytes.h"
#include "io/shape_bytes.h"
#include "tests/support/support.h"

namespace scree {
namespace {

ShapeSettings bricks()
{
    ShapeSettings settings;
    settings.storage = FieldStorage::bricks;
    return settings;
}

std::filesystem::path onlyFileIn(const std::filesystem::path& folder)
{
    const std::filesystem::directory_iterator first(folder);
    EXPECT_EQ(std::distance(begin(first), end(first)), 1);
    return std::filesystem::directory_iterator(folder)->path();
}

TEST(ShapeCache, AFieldFromTheCacheHasTheBitsOfAFieldJustBuilt)
{
    const test::TemporaryFolder folder;
    for (const ShapeSettings& settings : {ShapeSettings(), bricks()}) {
        ShapeCache first(folder.path()), second(folder.path());
        const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
        const auto built = buildMeshShape("ring", ring, settings, &first);
        const auto cached = buildMeshShape("ring", ring, settings, &second);
        EXPECT_EQ(first.keptCount(), 1);
        EXPECT_EQ(second.foundCount(), 1);
        EXPECT_EQ(second.keptCount(), 0);
        EXPECT_EQ(bytesOfField(1, built->distance.field()),
                  bytesOfField(1, cached->distance.field()));
        for (std::uint64_t i = 0; i < 1000; ++i) {
            const Vec3 p =
                built->box.min + built->box.size().cwiseProduct(
                                     Vec3(randomUnit(1, i), randomUnit(2, i), randomUnit(3, i)));
            ASSERT_EQ(built->distance.value(p), cached->distance.value(p));
        }
    }
    EXPECT_EQ(ShapeCache(folder.path()).size().files, 2);
}

TEST(ShapeCache, AnythingThatChangesTheFieldChangesItsName)
{
    const NodeLayout layout{Vec3::Zero(), 0.1, {10, 10, 10}};
    NodeLayout finer = layout, moved = layout;
    finer.spacing = 0.05;
    moved.origin.x() = 1e-9;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10}), other = makeTorus(1.0, 0.26, {16, 10});
    const auto dense = FieldStorage::dense;
    const std::uint64_t key = fieldKey(ring, layout, dense);
    EXPECT_NE(key, fieldKey(other, layout, dense));
    EXPECT_NE(key, fieldKey(ring, finer, dense));
    EXPECT_NE(key, fieldKey(ring, moved, dense));
    EXPECT_NE(key, fieldKey(ring, layout, FieldStorage::bricks));
    EXPECT_EQ(key, fieldKey(ring, layout, dense));
}

TEST(ShapeCache, ADamagedFileIsNoticedAndWrittenAnew)
{
    const test::TemporaryFolder folder;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    ShapeCache first(folder.path());
    buildMeshShape("ring", ring, bricks(), &first);
    const std::filesystem::path file = onlyFileIn(folder.path());
    const std::string good = readFileBytes(file);

    // Every header byte, and some of the rest: none may pass.
    const std::uint64_t key = std::stoull(file.stem().string(), nullptr, 16);
    ASSERT_TRUE(fieldOfBytes(key, good));
    for (std::size_t i = 0; i < good.size(); i += i < 200 ? 1 : good.size() / 50) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 4);
        ASSERT_FALSE(fieldOfBytes(key, bad)) << "byte " << i;
        ASSERT_FALSE(fieldOfBytes(key, good.substr(0, i))) << "cut at " << i;
    }
    ASSERT_FALSE(fieldOfBytes(key + 1, good));

    std::string bad = good;
    bad[good.size() / 2] = static_cast<char>(bad[good.size() / 2] ^ 1);
    writeFileBytes(file, bad);
    ShapeCache second(folder.path());
    buildMeshShape("ring", ring, bricks(), &second);
    EXPECT_EQ(second.foundCount(), 0);
    EXPECT_NE(second.problem().find("damaged"), std::string::npos);
    EXPECT_EQ(readFileBytes(file), good);
}

// On a farm one machine may have the next program a week before the others.
TEST(ShapeCache, WhatAProgramOfAnotherVersionHasKeptIsNeitherDamagedNorReplaced)
{
    const test::TemporaryFolder folder;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    ShapeCache first(folder.path());
    buildMeshShape("ring", ring, {}, &first);
    const std::filesystem::path file = onlyFileIn(folder.path());
    std::string name = file.filename().string();
    const std::string version = "-" + std::to_string(kFieldVersion) + ".";
    ASSERT_NE(name.find(version), std::string::npos);
    name.replace(name.find(version), version.size(), "-0.");
    std::filesystem::rename(file, folder / name);
    writeFileBytes(folder / name, "in another format");

    ShapeCache second(folder.path());
    buildMeshShape("ring", ring, {}, &second);
    EXPECT_EQ(second.keptCount(), 1);
    EXPECT_EQ(second.problem(), "");
    EXPECT_EQ(second.size().files, 2);
    EXPECT_EQ(readFileBytes(folder / name), "in another format");
}

/// Whether a field would be taken from a file whose checksum is right.
bool isAccepted(const DistanceField& field)
{
    return fieldOfBytes(1, bytesOfField(1, field)).has_value();
}

TEST(ShapeCache, AFileThatDoesNotFitTogetherIsRefusedThoughItsChecksumFits)
{
    for (const ShapeSettings& settings : {ShapeSettings(), bricks()}) {
        const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
        const auto shape = buildMeshShape("ring", ring, settings, nullptr);
        const DistanceField& good = shape->distance.field();
        ASSERT_TRUE(isAccepted(good));
        const auto refuses = [&](auto change) {
            DistanceField bad = good;
            change(bad);
            return !isAccepted(bad);
        };
        constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        for (const double spacing : {0.0, -0.1, 1e-310, 1e308, kInfinity, kNan}) {
            const auto change = [&](DistanceField& field) { field.nodes.layout.spacing = spacing; };
            EXPECT_TRUE(refuses(change)) << "spacing " << spacing;
        }
        for (const double x : {kInfinity, kNan}) {
            const auto change = [&](DistanceField& field) { field.nodes.layout.origin.y() = x; };
            EXPECT_TRUE(refuses(change)) << "origin " << x;
        }
        EXPECT_TRUE(refuses([](DistanceField& field) { field.nodes.layout.count[2] += 8; }));
        EXPECT_TRUE(refuses([](DistanceField& field) { field.nodes.blocks.pop_back(); }));
        EXPECT_TRUE(refuses([](DistanceField& field) { field.nodes.values.pop_back(); }));
        EXPECT_TRUE(refuses([](DistanceField& field) { field.nearest.faces.pop_back(); }));
        EXPECT_TRUE(refuses([](DistanceField& field) { field.nearest.start.pop_back(); }));
    }
}

TEST(ShapeCache, ALatticeLargerThanAnyMemoryIsRefusedBeforeMemoryIsAskedFor)
{
    constexpr int kMost = std::numeric_limits<int>::max();  // nodes, in 2²⁸ blocks
    DistanceField field;
    field.nodes.storage = FieldStorage::bricks;
    field.nodes.layout = {Vec3::Zero(), 0.1, {kMost, kMost, 2}};
    EXPECT_FALSE(isAccepted(field));
    field.nodes.layout.count = {kMost, kMost, 2 + 8 * 255};  // 2⁶⁴ blocks, which count as none
    EXPECT_FALSE(isAccepted(field));
}

TEST(ShapeCache, AFolderThatCannotBeMadeStopsNothing)
{
    const test::TemporaryFolder folder;
    writeFileBytes(folder / "file", "not a folder");
    ShapeCache cache(folder / "file");
    EXPECT_NE(buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}), {}, &cache), nullptr);
    EXPECT_FALSE(cache.problem().empty());
    ShapeCache none{std::filesystem::path()};
    EXPECT_NE(buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}), {}, &none), nullptr);
    EXPECT_TRUE(none.problem().empty());
}

ShapeSettings wrapped()
{
    ShapeSettings settings;
    settings.repair = MeshRepair::wrap;
    return settings;
}

TEST(ShapeCache, ARepairedSolidFromTheCacheHasTheBitsOfOneJustMade)
{
    const test::TemporaryFolder folder;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    ShapeCache first(folder.path()), second(folder.path());
    const auto made = buildMeshShape("ring", ring, wrapped(), &first);
    const auto cached = buildMeshShape("ring", ring, wrapped(), &second);
    EXPECT_EQ(first.keptCount(), 2);  // and the field of the solid
    EXPECT_EQ(second.foundCount(), 2);
    EXPECT_EQ(second.keptCount(), 0);
    EXPECT_EQ(bytesOfSolid(1, made->mesh), bytesOfSolid(1, cached->mesh));
    EXPECT_EQ(made->repairs.drawnToColliding.distance, cached->repairs.drawnToColliding.distance);
}

TEST(ShapeCache, AnythingThatChangesARepairChangesItsName)
{
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10}), other = makeTorus(1.0, 0.26, {16, 10});
    const RemeshSettings wrap{MeshRepair::wrap, 0.0, 0.1}, finer{MeshRepair::wrap, 0.0, 0.05};
    const RemeshSettings shell{MeshRepair::shell, 0.1, 0.1}, thicker{MeshRepair::shell, 0.2, 0.1};
    std::set<std::uint64_t> keys = {solidKey(other, wrap)};
    for (const RemeshSettings& how : {wrap, finer, shell, thicker})
        keys.insert(solidKey(ring, how));
    EXPECT_EQ(keys.size(), 5u);
    EXPECT_EQ(solidKey(ring, wrap), solidKey(TriMesh(ring), wrap));
}

TEST(ShapeCache, ASolidThatIsDamagedOrHasCornersItLacksIsRefused)
{
    const TriMesh cube = makeBox(Vec3::Ones(), {1, 1, 1});
    const std::string good = bytesOfSolid(7, cube);
    ASSERT_TRUE(solidOfBytes(7, good));
    EXPECT_EQ(bytesOfSolid(7, *solidOfBytes(7, good)), good);
    EXPECT_FALSE(solidOfBytes(8, good));
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 4);
        ASSERT_FALSE(solidOfBytes(7, bad)) << "byte " << i;
        ASSERT_FALSE(solidOfBytes(7, good.substr(0, i))) << "cut at " << i;
    }
    const auto refuses = [&](auto change) {
        TriMesh bad = cube;
        change(bad);
        return !solidOfBytes(7, bytesOfSolid(7, bad));
    };
    EXPECT_TRUE(refuses([](TriMesh& m) { m.triangles(1, 3) = static_cast<int>(m.points.cols()); }));
    EXPECT_TRUE(refuses([](TriMesh& m) { m.triangles(1, 3) = -1; }));
    EXPECT_TRUE(refuses([](TriMesh& m) { m.points(2, 0) = std::nan(""); }));
    EXPECT_TRUE(refuses([](TriMesh& m) { m.triangles.resize(3, 0); }));
}

// A year of shots had left four gigabytes in it.
TEST(ShapeCache, WhatWasNotUsedForLongestGoesWhenThereIsTooMuch)
{
    const test::TemporaryFolder folder;
    const TriMesh ring = makeTorus(1.0, 0.25, {16, 10});
    ShapeCache first(folder.path());
    buildMeshShape("ring", ring, {}, &first);
    const std::filesystem::path used = onlyFileIn(folder.path());
    const std::filesystem::path old = folder / "0000000000000001.field";
    const std::filesystem::path recent = folder / "0000000000000002.solid";
    const std::filesystem::path foreign = folder / "notes.txt";
    const auto now = std::filesystem::file_time_type::clock::now();
    const auto put = [&](const std::filesystem::path& file, int hoursAgo) {
        writeFileBytes(file, "");
        std::filesystem::resize_file(file, std::uintmax_t{5} << 29);  // 2.5 GiB of nothing
        std::filesystem::last_write_time(file, now - std::chrono::hours(hoursAgo));
    };
    put(old, 3);
    put(recent, 1);
    put(foreign, 9);
    std::filesystem::last_write_time(used, now - std::chrono::hours(5));

    ShapeCache second(folder.path());
    buildMeshShape("ring", ring, {}, &second);
    EXPECT_TRUE(std::filesystem::exists(old));  // nothing was to be kept
    buildMeshShape("cube", makeBox(Vec3::Ones(), {1, 1, 1}), {}, &second);
    EXPECT_FALSE(std::filesystem::exists(old));
    EXPECT_TRUE(std::filesystem::exists(used));
    EXPECT_TRUE(std::filesystem::exists(recent));
    EXPECT_TRUE(std::filesystem::exists(foreign));
}

}  // namespace
}  // namespace scree
