// Pixels and the sRGB transfer curve of IEC 61966-2-1.
#include "render/image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"

namespace scree {
namespace {

/// Linear value of an sRGB value, both 0 … 1.
double linearFromSrgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The curve without a power per pixel. The byte of a linear value is the number of thresholds at
/// or below it, threshold b being the linear value half way between the bytes b and b + 1. The
/// count is started from the lower end of the value's bucket, at most a few steps too low.
struct SrgbTable {
    static constexpr int kBucketCount = 4096;

    std::array<float, 256> linear{};
    std::array<float, 256> threshold{};
    std::array<std::uint8_t, kBucketCount + 1> firstByte{};

    SrgbTable()
    {
        for (int b = 0; b < 256; ++b) {
            linear[b] = static_cast<float>(linearFromSrgb(b / 255.0));
            threshold[b] = static_cast<float>(linearFromSrgb((b + 0.5) / 255.0));
        }
        threshold[255] = 2.0f;  // no value reaches byte 256
        int byte = 0;
        for (int bucket = 0; bucket <= kBucketCount; ++bucket) {
            while (threshold[byte] <= static_cast<float>(bucket) / kBucketCount) ++byte;
            firstByte[bucket] = static_cast<std::uint8_t>(byte);
        }
    }
};

const SrgbTable& srgbTable()
{
    static const SrgbTable table;
    return table;
}

std::uint8_t encoded(const SrgbTable& table, float linear)
{
    if (!(linear > 0.0f)) return 0;  // NaN is black too
    const float clamped = std::min(linear, 1.0f);
    int byte = table.firstByte[static_cast<int>(clamped * SrgbTable::kBucketCount)];
    while (table.threshold[byte] <= clamped) ++byte;
    return static_cast<std::uint8_t>(byte);
}

/// What one new row or column of a downscaled picture covers of the old one.
struct Coverage {
    int first = 0;
    std::vector<float> weights;  // of first, first + 1, …; their sum is 1
};

std::vector<Coverage> coverages(int oldCount, int newCount)
{
    std::vector<Coverage> result(newCount);
    const double ratio = static_cast<double>(oldCount) / newCount;
    for (int i = 0; i < newCount; ++i) {
        const double begin = i * ratio;
        const double end = std::min<double>((i + 1) * ratio, oldCount);
        result[i].first = static_cast<int>(begin);
        for (int k = result[i].first; k < end; ++k) {
            const double covered = std::min<double>(k + 1, end) - std::max<double>(k, begin);
            result[i].weights.push_back(static_cast<float>(covered / (end - begin)));
        }
    }
    return result;
}

Image withFewerColumns(const Image& image, int width)
{
    Image result(width, image.height);
    const std::vector<Coverage> columns = coverages(image.width, width);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < width; ++x) {
            Color mean = Color::Zero();
            for (std::size_t k = 0; k < columns[x].weights.size(); ++k)
                mean += columns[x].weights[k] * image.at(columns[x].first + static_cast<int>(k), y);
            result.set(x, y, mean);
        }
    }
    return result;
}

Image withFewerRows(const Image& image, int height)
{
    Image result(image.width, height);
    const std::vector<Coverage> rows = coverages(image.height, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            Color mean = Color::Zero();
            for (std::size_t k = 0; k < rows[y].weights.size(); ++k)
                mean += rows[y].weights[k] * image.at(x, rows[y].first + static_cast<int>(k));
            result.set(x, y, mean);
        }
    }
    return result;
}

}  // namespace

Image::Image(int imageWidth, int imageHeight, const Color& fill)
    : width(imageWidth), height(imageHeight)
{
    SCREE_CHECK(width >= 0 && height >= 0, "an image of negative size");
    values.resize(static_cast<std::size_t>(width) * height * 3);
    if (fill.isZero(0.0f)) return;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = fill[i % 3];
}

std::size_t Image::indexOf(int x, int y) const
{
    return (static_cast<std::size_t>(y) * width + x) * 3;
}

Color Image::at(int x, int y) const
{
    const std::size_t i = indexOf(x, y);
    return {values[i], values[i + 1], values[i + 2]};
}

void Image::set(int x, int y, const Color& color)
{
    const std::size_t i = indexOf(x, y);
    for (int channel = 0; channel < 3; ++channel) values[i + channel] = color[channel];
}

std::vector<std::uint8_t> toSrgbBytes(const Image& image)
{
    const SrgbTable& table = srgbTable();
    std::vector<std::uint8_t> bytes(image.values.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = encoded(table, image.values[i]);
    return bytes;
}

Image fromSrgbBytes(int width, int height, std::span<const std::uint8_t> bytes)
{
    Image image(width, height);
    SCREE_CHECK(bytes.size() == image.values.size(), "bytes do not fill the image");
    const SrgbTable& table = srgbTable();
    std::transform(bytes.begin(), bytes.end(), image.values.begin(),
                   [&](std::uint8_t byte) { return table.linear[byte]; });
    return image;
}

Image fromOpenGl(int width, int height, std::span<const std::uint8_t> bytes)
{
    const SrgbTable& table = srgbTable();
    Image image(width, height);
    SCREE_CHECK(3 * bytes.size() == 4 * image.values.size(), "bytes do not fill the image");
    float* value = image.values.data();
    for (int y = height - 1; y >= 0; --y) {
        const std::uint8_t* byte = bytes.data() + static_cast<std::size_t>(y) * width * 4;
        for (int x = 0; x < width; ++x, byte += 4, value += 3)
            for (int channel = 0; channel < 3; ++channel)
                value[channel] = table.linear[byte[channel]];
    }
    return image;
}

Image downscaled(const Image& image, int width, int height)
{
    SCREE_CHECK(width >= 1 && height >= 1 && width <= image.width && height <= image.height,
                "downscaling can only make a picture smaller");
    return withFewerRows(withFewerColumns(image, width), height);
}

void addShare(Image& image, const Image& source, float share)
{
    SCREE_CHECK(image.values.size() == source.values.size(), "pictures of different sizes");
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] += share * source.values[i];
}

void paste(Image& target, const Image& source, int x, int y)
{
    const int firstX = std::max(0, -x), endX = std::min(source.width, target.width - x);
    const int firstY = std::max(0, -y), endY = std::min(source.height, target.height - y);
    for (int sourceY = firstY; sourceY < endY; ++sourceY)
        for (int sourceX = firstX; sourceX < endX; ++sourceX)
            target.set(x + sourceX, y + sourceY, source.at(sourceX, sourceY));
}

void blendRectangle(Image& image, int x, int y, int width, int height, const Color& color,
                    float opacity)
{
    for (int row = std::max(0, y); row < std::min(image.height, y + height); ++row) {
        for (int column = std::max(0, x); column < std::min(image.width, x + width); ++column) {
            const Color mixed = (1.0f - opacity) * image.at(column, row) + opacity * color;
            image.set(column, row, mixed);
        }
    }
}

}  // namespace scree
