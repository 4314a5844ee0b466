// Both directions are one piece of code: a "line" is a row or a column of pixels, and a seam runs
// between a line and the next wherever their pixels differ. Seams are found for the whole picture
// first and pixels are changed last, so the order of the work leaves no trace.
#include "render/edge_smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace scree {
namespace {

/// Differences of display brightness that count as an edge [0 … 255]; smaller ones are shading.
constexpr int kLeastContrast = 14;

/// A seam longer than this is straight for the eye [pixels].
constexpr int kLongestSeam = 48;

/// Brightness as a display shows it, so that an edge in shadow counts like one in the sun.
std::vector<std::uint8_t> brightnessOf(const Image& image)
{
    std::vector<std::uint8_t> result(static_cast<std::size_t>(image.width) * image.height);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const float* c = image.values.data() + 3 * i;
        const float light = 0.30f * c[0] + 0.55f * c[1] + 0.15f * c[2];
        result[i] = static_cast<std::uint8_t>(255.0f * std::sqrt(std::clamp(light, 0.0f, 1.0f)));
    }
    return result;
}

/// Which pixels differ from their right and from their lower neighbour.
struct Seams {
    int width = 0, height = 0;
    std::vector<std::uint8_t> toRight, toBelow;
};

Seams findSeams(const std::vector<std::uint8_t>& brightness, int width, int height)
{
    Seams seams{width, height, {}, {}};
    seams.toRight.assign(brightness.size(), 0);
    seams.toBelow.assign(brightness.size(), 0);
    for (int y = 0; y < height; ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * width;
        for (int x = 0; x + 1 < width; ++x)
            seams.toRight[row + x] =
                std::abs(brightness[row + x] - brightness[row + x + 1]) >= kLeastContrast;
        if (y + 1 == height) break;
        for (int x = 0; x < width; ++x)
            seams.toBelow[row + x] =
                std::abs(brightness[row + x] - brightness[row + width + x]) >= kLeastContrast;
    }
    return seams;
}

/// What a seam does at one of its ends: 1 it turns into the near line, −1 into the far one, 0
/// neither or both.
int turnOf(bool turnsNear, bool turnsFar)
{
    return static_cast<int>(turnsNear) - static_cast<int>(turnsFar);
}

/// How much of the pixel `place` of a seam of `length` the straight edge cuts off that comes from
/// the seam's beginning: half a pixel high there, nothing in the middle.
float shareFromEnd(int place, int length)
{
    const float middle = 0.5f * static_cast<float>(length);
    const float from = std::min(static_cast<float>(place), middle);
    const float to = std::min(static_cast<float>(place + 1), middle);
    return 0.5f * ((to - from) - (to * to - from * from) / (2.0f * middle));
}

/// Shares of a pixel's colour that it takes from its neighbours.
struct Blend {
    std::uint32_t pixel = 0, neighbour = 0;
    float share = 0.0f;
};

/// Follows the seams between a line and the next. `along` is from pixel to pixel in a line,
/// `across` from the line to the next; `isSeam` tells where lines differ, `isStep` where a pixel
/// differs from the next of its own line.
void followSeams(std::uint32_t line, int count, std::uint32_t along, std::uint32_t across,
                 const std::vector<std::uint8_t>& isSeam, const std::vector<std::uint8_t>& isStep,
                 std::vector<Blend>& blends)
{
    for (int begin = 0; begin < count;) {
        if (!isSeam[line + begin * along]) {
            ++begin;
            continue;
        }
        int end = begin + 1;
        while (end < count && isSeam[line + end * along]) ++end;
        // A step that goes on in the line beyond is a corner or a steeper edge, whose seam runs the
        // other way: it does not bend this one.
        const auto stepsBefore = [&](int place, std::int64_t offset) {
            const std::int64_t step = line + offset + (place - 1) * std::int64_t{along};
            return place > 0 && place < count && step >= 0 &&
                   step < static_cast<std::int64_t>(isStep.size()) && isStep[step];
        };
        const auto turnAt = [&](int place) {
            const std::int64_t next = across;
            return turnOf(stepsBefore(place, 0) && !stepsBefore(place, -next),
                          stepsBefore(place, next) && !stepsBefore(place, 2 * next));
        };
        const int length = end - begin, turnBegin = turnAt(begin), turnEnd = turnAt(end);
        for (int k = 0; k < length && length <= kLongestSeam; ++k) {
            const std::uint32_t near = line + (begin + k) * along, far = near + across;
            const auto cut = [&](int turn, float share) {
                if (turn == 0 || share <= 0.0f) return;
                blends.push_back(turn > 0 ? Blend{near, far, share} : Blend{far, near, share});
            };
            cut(turnBegin, shareFromEnd(k, length));
            cut(turnEnd, shareFromEnd(length - 1 - k, length));
        }
        begin = end;
    }
}

}  // namespace

void smoothEdges(Image& image)
{
    const int width = image.width, height = image.height;
    if (width < 2 || height < 2) return;
    const Seams seams = findSeams(brightnessOf(image), width, height);
    std::vector<Blend> blends;
    const auto stride = static_cast<std::uint32_t>(width);
    for (int y = 0; y + 1 < height; ++y)
        followSeams(stride * y, width, 1, stride, seams.toBelow, seams.toRight, blends);
    for (int x = 0; x + 1 < width; ++x)
        followSeams(x, height, stride, 1, seams.toRight, seams.toBelow, blends);

    // Take all differences from the picture as it was.
    std::vector<Color> changes;
    changes.reserve(blends.size());
    const auto colorAt = [&](std::uint32_t pixel) {
        return Color(Color::Map(image.values.data() + 3 * static_cast<std::size_t>(pixel)));
    };
    for (const Blend& blend : blends)
        changes.push_back(blend.share * (colorAt(blend.neighbour) - colorAt(blend.pixel)));
    for (std::size_t i = 0; i < blends.size(); ++i) {
        float* pixel = image.values.data() + 3 * static_cast<std::size_t>(blends[i].pixel);
        for (int channel = 0; channel < 3; ++channel)
            pixel[channel] = std::max(pixel[channel] + changes[i][channel], 0.0f);
    }
}

}  // namespace scree
