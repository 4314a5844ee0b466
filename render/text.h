// Words in pictures: labels of contact sheets and the burn-in of previews, in a built-in bitmap
// font.
#pragma once

#include <string>

#include "render/image.h"

namespace scree {

/// Height of a line of text in pixels at scale 1, without the space to the next line.
inline constexpr int kTextHeight = 8;

/// Width in pixels of one line of text.
int textWidth(const std::string& text, int scale);

/// Draws one line with its top left corner at (x, y); each dot of the font is scale × scale pixels.
/// Printable ASCII is known, any other byte is drawn as a question mark.
void drawText(Image& image, int x, int y, int scale, const std::string& text, const Color& color);

/// Writes one line into the lower left corner, on a darkened strip, in a size that can be read
/// whatever the size of the picture.
void burnIn(Image& image, const std::string& text);

}  // namespace scree
