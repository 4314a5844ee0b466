// The layer below schemas, at the edges of its number formats. Bytes are judged by abc_check.py,
// which reads every block, recomputes every digest and compares sample counts.
#include "io/alembic_archive.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "io/byte_order.h"
#include "tests/support/abc_check.h"
#include "tests/support/support.h"

namespace scree {
namespace {

std::string hex(std::string_view bytes)
{
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::string text;
    for (const char byte : bytes) {
        text += kDigits[static_cast<unsigned char>(byte) >> 4];
        text += kDigits[static_cast<unsigned char>(byte) & 15];
    }
    return text;
}

/// A track of single doubles; equal neighbours share their block.
SampleTrack trackOf(AlembicArchive& archive, const std::vector<double>& values)
{
    SampleTrack track;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && values[i] == values[i - 1]) {
            track.repeatLast();
        } else {
            track.append(archive.writeScalar(bytesOf(std::array<double, 1>{values[i]})));
        }
    }
    return track;
}

AlembicLayout layoutOf(const std::string& name, int sampling, const std::string& metadata = "")
{
    return {name, AlembicKind::scalar, AlembicType::f64, 1, sampling, metadata};
}

void finishWith(AlembicArchive& archive, const std::vector<AlembicProperty>& properties)
{
    const AlembicObject object = archive.writeObject("object", "kind=test", properties, {});
    archive.finish(std::span(&object, 1), "_ai_Application=test");
}

void expectStrictlyValid(const std::filesystem::path& file)
{
    const test::CommandResult result = test::runAbcCheck(file, "--strict --quiet");
    EXPECT_EQ(result.exitCode, 0) << result.output;
}

// The headers of body_a in the reference file of the official library.
TEST(AlembicArchive, WritesHeadersLikeTheReferenceFile)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    const int everyFrame = archive.addCyclicSampling({1.0 / 24.0}, 1.0 / 24.0);

    const AlembicSample one = archive.writeScalar(std::string_view("\x01", 1));
    SampleTrack rest;
    for (int i = 0; i < 5; ++i) rest.append(one);
    const AlembicLayout inherits = {".inherits", AlembicKind::scalar, AlembicType::boolean,
                                    1,           everyFrame,          ""};
    EXPECT_EQ(hex(archive.writeProperty(inherits, rest).header),
              "011D0000050109" + hex(".inherits"));
    const AlembicLayout ops = {".ops", AlembicKind::scalar, AlembicType::u8, 1, 0, ""};
    EXPECT_EQ(hex(archive.writeProperty(ops, rest).header), "111C00000504" + hex(".ops"));

    AlembicLayout values = layoutOf(".vals", everyFrame);
    values.extent = 16;
    EXPECT_EQ(hex(archive.writeProperty(values, trackOf(archive, {0, 1, 2, 3, 4})).header),
              "B1050100050105" + hex(".vals"));

    const std::vector<std::uint32_t> seven = {0, 1, 4, 5, 12, 13, 14};
    const SampleTrack channels(archive.writeArray(bytesOf(seven), seven.size()));
    const AlembicLayout animated = {
        ".animChans", AlembicKind::array, AlembicType::u32, 1, everyFrame, ""};
    EXPECT_EQ(hex(archive.writeProperty(animated, channels).header),
              "521D000001010A" + hex(".animChans"));
}

TEST(AlembicArchive, WithoutObjectsItIsStillAnArchive)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    archive.finish({}, "");
    expectStrictlyValid(folder / "a.abc");
}

TEST(AlembicArchive, StoresOnlyTheRangeFromFirstToLastChange)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    struct Case {
        const char* name;
        std::vector<double> values;
        std::uint32_t first, last;
        std::size_t stored;
    };
    const Case cases[] = {
        {"p0000", {0, 0, 0, 0}, 0, 0, 1},         {"p0123", {0, 1, 2, 3}, 1, 3, 4},
        {"p0011", {0, 0, 1, 1}, 2, 2, 2},         {"p0111", {0, 1, 1, 1}, 1, 1, 2},
        {"p0010", {0, 0, 1, 0}, 2, 3, 3},         {"p0101", {0, 1, 0, 1}, 1, 3, 4},
        {"p011101", {0, 1, 1, 1, 0, 1}, 1, 5, 6},
    };
    const int everyFrame = archive.addCyclicSampling({0.0}, 1.0 / 24.0);
    std::vector<AlembicProperty> properties;
    for (const Case& example : cases) {
        const SampleTrack track = trackOf(archive, example.values);
        EXPECT_EQ(track.firstChange(), example.first) << example.name;
        EXPECT_EQ(track.lastChange(), example.last) << example.name;
        EXPECT_EQ(track.entries().size(), example.stored) << example.name;
        properties.push_back(archive.writeProperty(layoutOf(example.name, everyFrame), track));
    }
    finishWith(archive, properties);
    expectStrictlyValid(folder / "a.abc");
}

TEST(AlembicArchive, CountsSamplesAcrossTheWidthsOfItsIntegers)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    const int everyFrame = archive.addCyclicSampling({0.0}, 1.0 / 24.0);
    std::vector<AlembicProperty> properties;
    for (const std::size_t count : {1u, 255u, 256u, 65535u, 65536u}) {
        std::vector<double> values(count, 0.0);
        if (count > 1) values.back() = 1.0;
        const std::string name = "n" + std::to_string(count);
        properties.push_back(
            archive.writeProperty(layoutOf(name, everyFrame), trackOf(archive, values)));
    }
    finishWith(archive, properties);
    const test::CommandResult result = test::runAbcCheck(folder / "a.abc", "--strict");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_NE(result.output.find("n65536 scalar float64_t samples=65536 stored=2"),
              std::string::npos)
        << result.output;
}

TEST(AlembicArchive, KeepsMetadataThatDoesNotFitItsTable)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    std::vector<AlembicProperty> properties;
    const SampleTrack track = trackOf(archive, {1.0});
    for (int i = 0; i < 260; ++i) {  // the table ends at 254
        const std::string number = std::to_string(i);
        properties.push_back(
            archive.writeProperty(layoutOf("p" + number, 0, "k=" + number), track));
    }
    const std::string longText = "k=" + std::string(300, 'x');
    properties.push_back(archive.writeProperty(layoutOf("long_metadata", 0, longText), track));
    properties.push_back(archive.writeProperty(layoutOf(std::string(300, 'n'), 0), track));
    properties.push_back(archive.writeCompound("empty_compound", longText, {}));
    finishWith(archive, properties);

    const test::CommandResult result = test::runAbcCheck(folder / "a.abc", "--strict");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_NE(result.output.find(" k=259\n"), std::string::npos);
    EXPECT_NE(result.output.find(" " + longText + "\n"), std::string::npos);
}

TEST(AlembicArchive, ObjectsMayHaveHundredsOfChildrenAndLongMetadata)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    std::vector<AlembicObject> children;
    for (int i = 0; i < 300; ++i) {
        const std::string metadata = "kind=" + std::string(i % 2 ? 10 : 290, 'y');
        children.push_back(archive.writeObject("child" + std::to_string(i), metadata, {}, {}));
    }
    archive.finish(children, "");
    expectStrictlyValid(folder / "a.abc");
}

TEST(AlembicArchive, EmptyArraysHaveNoBlock)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "a.abc");
    const AlembicLayout layout = {"none", AlembicKind::array, AlembicType::i32, 1, 0, ""};
    const AlembicSample empty = archive.writeArray({}, 0);
    EXPECT_EQ(empty.data, kEmptyData);
    finishWith(archive, {archive.writeProperty(layout, SampleTrack(empty))});
    expectStrictlyValid(folder / "a.abc");
}

}  // namespace
}  // namespace scree
