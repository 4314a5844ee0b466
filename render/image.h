// Pictures in linear light: sums, averages and blends of pixels are then sums of light. Only files
// and the rasteriser's own buffer hold display-encoded (sRGB) bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace scree {

/// Red, green, blue; linear light, 0 … 1 is what a display can show.
using Color = Eigen::Vector3f;

/// Rows run from top to bottom, pixels from left to right, three floats each.
struct Image {
    Image() = default;
    Image(int imageWidth, int imageHeight, const Color& fill = Color::Zero());

    int width = 0;
    int height = 0;
    std::vector<float> values;  // height × width × 3

    Color at(int x, int y) const;
    void set(int x, int y, const Color& color);

private:
    std::size_t indexOf(int x, int y) const;
};

/// All pixels as sRGB bytes, three each, in the order of Image: the bytes nearest to the encoding
/// of linear values, which are clamped to 0 … 1 first.
std::vector<std::uint8_t> toSrgbBytes(const Image& image);

/// The opposite: width × height × 3 sRGB bytes, top row first. toSrgbBytes gives the same back.
Image fromSrgbBytes(int width, int height, std::span<const std::uint8_t> bytes);

/// From OpenGL's memory: width × height × 4 sRGB bytes, bottom row first, the fourth ignored.
Image fromOpenGl(int width, int height, std::span<const std::uint8_t> bytes);

/// The picture at another, smaller or equal size: every new pixel is the mean of the area it
/// covers.
Image downscaled(const Image& image, int width, int height);

/// Adds `share` times `source`, which has the same size, to every pixel.
void addShare(Image& image, const Image& source, float share);

/// Copies `source` with its top left corner to (x, y); what falls outside `target` is dropped.
void paste(Image& target, const Image& source, int x, int y);

/// Mixes `color` into the rectangle with top left corner (x, y); opacity 1 replaces.
void blendRectangle(Image& image, int x, int y, int width, int height, const Color& color,
                    float opacity);

}  // namespace scree
