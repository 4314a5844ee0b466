#include "render/png_writer.h"

#include <png.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/support.h"

namespace scree {
namespace {

Image gradient(int width, int height)
{
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int value : {3 * x, 5 * y, x * y}) bytes.push_back(value % 256);
    return fromSrgbBytes(width, height, bytes);
}

template <class Function>
ErrorKind kindOfErrorFrom(Function function, const std::string& mustBeNamed)
{
    try {
        function();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(mustBeNamed), std::string::npos) << error.what();
        return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorKind::internal;
}

std::size_t fileCount(const std::filesystem::path& folder)
{
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(PngWriter, StoresThePixelsItWasGiven)
{
    const test::TemporaryFolder folder;
    const Image image = gradient(97, 31);
    writePng(folder / "a.png", image);
    const Image read = readPng(folder / "a.png").image;
    EXPECT_EQ(read.width, 97);
    EXPECT_EQ(read.height, 31);
    EXPECT_EQ(read.values, image.values);
}

TEST(PngWriter, OtherReadersSeeTheSameBytes)
{
    const test::TemporaryFolder folder;
    const Image image = gradient(64, 40);
    writePng(folder / "a.png", image);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder / "a.png").c_str()));
    png.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(png));
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
    EXPECT_EQ(bytes, toSrgbBytes(image));
}

TEST(PngWriter, MarksTheFileAsSrgb)
{
    const std::vector<std::uint8_t> bytes = encodePng(gradient(4, 4));
    constexpr std::string_view kChunk = "sRGB";
    EXPECT_NE(std::search(bytes.begin(), bytes.end(), kChunk.begin(), kChunk.end()), bytes.end());
}

TEST(PngWriter, KeepsTextsInOrder)
{
    const test::TemporaryFolder folder;
    const PngText text = {{"Software", "scree"}, {"Frame", "1001"}, {"Comment", "grün"}};
    writePng(folder / "a.png", gradient(8, 8), text);
    EXPECT_EQ(readPng(folder / "a.png").text, text);
}

TEST(PngWriter, ReplacesAnOlderFileAndLeavesNothingElse)
{
    const test::TemporaryFolder folder;
    writePng(folder / "a.png", gradient(8, 8));
    writePng(folder / "a.png", gradient(9, 9));
    EXPECT_EQ(readPng(folder / "a.png").image.width, 9);
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

TEST(PngWriter, NamesThePathThatCannotBeCreated)
{
    const test::TemporaryFolder folder;
    const auto path = folder / "no_such_folder/a.png";
    EXPECT_EQ(kindOfErrorFrom([&] { writePng(path, gradient(8, 8)); }, path.string()),
              ErrorKind::cannotCreate);
}

TEST(PngWriter, LeavesNoTemporaryFileWhenTheNameIsTaken)
{
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a.png");
    const auto path = folder / "a.png";
    EXPECT_EQ(kindOfErrorFrom([&] { writePng(path, gradient(8, 8)); }, path.string()),
              ErrorKind::cannotCreate);
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

TEST(PngReader, TellsAMissingFileFromADamagedOne)
{
    const test::TemporaryFolder folder;
    const auto missing = folder / "missing.png", cut = folder / "cut.png", odd = folder / "odd.png";
    EXPECT_EQ(kindOfErrorFrom([&] { readPng(missing); }, missing.string()),
              ErrorKind::missingInput);

    const std::vector<std::uint8_t> bytes = encodePng(gradient(50, 50));
    std::ofstream(cut, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size() / 2));
    EXPECT_EQ(kindOfErrorFrom([&] { readPng(cut); }, cut.string()), ErrorKind::inputOutput);

    std::ofstream(odd) << "This is no picture.";
    EXPECT_EQ(kindOfErrorFrom([&] { readPng(odd); }, odd.string()), ErrorKind::inputOutput);
}

}  // namespace
}  // namespace scree
