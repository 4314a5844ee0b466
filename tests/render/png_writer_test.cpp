#include "render/png_writer.h"

#include <png.h>

#include <algorithm>
#include <span>
#include <string_view>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/refusal.h"

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

TEST(PngWriter, StoresThePixelsItWasGiven)
{
    const Image image = gradient(97, 31);
    const Image read = decodePng(encodePng(image), "a.png").image;
    EXPECT_EQ(read.width, 97);
    EXPECT_EQ(read.height, 31);
    EXPECT_EQ(read.values, image.values);
}

TEST(PngWriter, OtherReadersSeeTheSameBytes)
{
    const Image image = gradient(64, 40);
    const std::vector<std::uint8_t> file = encodePng(image);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_memory(&png, file.data(), file.size()));
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
    const PngText text = {{"Software", "scree"}, {"Frame", "1001"}, {"Comment", "grün"}};
    EXPECT_EQ(decodePng(encodePng(gradient(8, 8), text), "a.png").text, text);
}

TEST(PngReader, NamesTheFileThatIsDamaged)
{
    const auto messageFrom = [](std::span<const std::uint8_t> bytes) -> std::string {
        const test::Refusal refusal =
            test::refusalBy([&] { requireWholePng(bytes, "shots/cut.png"); });
        EXPECT_EQ(refusal.kind.value_or(ErrorKind::inputOutput), ErrorKind::inputOutput);
        return refusal.message;
    };
    const std::vector<std::uint8_t> whole = encodePng(gradient(50, 50));
    EXPECT_EQ(messageFrom(whole), "nothing was thrown");
    const std::span<const std::uint8_t> bytes = whole;
    for (const std::size_t size : {std::size_t{0}, std::size_t{30}, whole.size() / 2}) {
        EXPECT_NE(messageFrom(bytes.first(size)).find("shots/cut.png"), std::string::npos) << size;
    }
    const std::vector<std::uint8_t> odd = {'n', 'o', ' ', 'p', 'i', 'c', 't', 'u', 'r', 'e'};
    EXPECT_NE(messageFrom(odd).find("shots/cut.png"), std::string::npos);
}

}  // namespace
}  // namespace scree
