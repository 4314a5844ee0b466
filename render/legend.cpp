// Legends and slates.
#include "render/legend.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "render/text.h"

namespace scree {
namespace {

const Color kInk = Color::Constant(0.85f), kPaper = Color::Constant(0.01f);
constexpr float kPaperOpacity = 0.6f;

int textScale(const Image& image)
{
    return std::max(1, (image.height + 180) / 360);
}

/// A darkened strip for one line of text, and where the text begins.
std::array<int, 2> openLine(Image& image, int line, int width)
{
    const int scale = textScale(image), border = 4 * scale;
    const int height = kTextHeight * scale + border;
    blendRectangle(image, 0, line * height, width + 2 * border, height, kPaper, kPaperOpacity);
    return {border, line * height + border / 2};
}

}  // namespace

Color scaleColor(double share)
{
    // Dark blue over violet and orange to light yellow.
    static const std::array<Color, 5> stops = {
        Color(0.015f, 0.02f, 0.10f), Color(0.13f, 0.03f, 0.24f), Color(0.45f, 0.06f, 0.12f),
        Color(0.82f, 0.27f, 0.03f), Color(0.95f, 0.85f, 0.25f)};
    const double clamped = share > 0.0 ? std::min(share, 1.0) : 0.0;
    const double place = clamped * (stops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const auto rest = static_cast<float>(place - static_cast<double>(below));
    return (1.0f - rest) * stops[below] + rest * stops[below + 1];
}

void drawLegend(Image& image, const Legend& legend)
{
    const int scale = textScale(image), swatch = kTextHeight * scale;
    int line = 0;
    for (const auto& [color, meaning] : legend.entries) {
        const int indent = swatch + 4 * scale;
        const auto [x, y] = openLine(image, line++, indent + textWidth(meaning, scale));
        blendRectangle(image, x, y, swatch, swatch, color, 1.0f);
        drawText(image, x + indent, y, scale, meaning, kInk);
    }
    if (!(legend.scaleEnd > 0.0)) return;

    char end[64];
    std::snprintf(end, sizeof end, "%g ", legend.scaleEnd);
    const std::string text = end + legend.title;
    const int bar = 96 * scale, zero = textWidth("0 ", scale) + scale;
    const auto [x, y] = openLine(image, line, zero + bar + 4 * scale + textWidth(text, scale));
    drawText(image, x, y, scale, "0", kInk);
    for (int i = 0; i < bar; ++i)
        blendRectangle(image, x + zero + i, y, 1, swatch, scaleColor((i + 0.5) / bar), 1.0f);
    drawText(image, x + zero + bar + 4 * scale, y, scale, text, kInk);
}

Image makeSlate(int width, int height, const std::vector<std::string>& lines)
{
    Image slate(width, height, Color::Constant(0.015f));
    int scale = std::max(1, height / 120), y = height / 5;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        int fitting = scale;
        while (fitting > 1 && textWidth(lines[i], fitting) > width * 9 / 10) --fitting;
        drawText(slate, width / 20, y, fitting, lines[i], Color::Constant(i == 0 ? 0.9f : 0.6f));
        y += 2 * kTextHeight * scale;
        if (i == 0) scale = std::max(1, scale / 2);
    }
    return slate;
}

}  // namespace scree
