// What the colours of a diagnostic picture mean, written into it; and cards of text, as slates are.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/image.h"

namespace scree {

struct Legend {
    std::vector<std::pair<Color, std::string>> entries;  ///< a colour and its meaning
    double scaleEnd = 0.0;                               ///< > 0: a scale of colours from 0 to this
    std::string title;                                   ///< of the scale
};

/// The colour at `share` of the scale, 0 … 1; values outside take the colour of the end. Its
/// brightness rises all the way, so that it can be read without colours too.
Color scaleColor(double share);

/// Draws into the upper left corner; an empty legend draws nothing.
void drawLegend(Image& image, const Legend& legend);

/// A picture of nothing but text: a large first line, smaller ones below.
Image makeSlate(int width, int height, const std::vector<std::string>& lines);

}  // namespace scree
