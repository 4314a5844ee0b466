// The grid and its labels.
#include "render/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/error.h"
#include "render/text.h"

namespace scree {
namespace {

const Color kPaper = Color::Constant(0.012f);
const Color kInk = Color::Constant(0.6f);

/// The largest picture of the same proportions within width × height, never enlarged.
Image fitted(const Image& image, int width, int height)
{
    const double ratio = std::min({1.0, static_cast<double>(width) / image.width,
                                   static_cast<double>(height) / image.height});
    const int newWidth = std::max(1, static_cast<int>(std::lround(ratio * image.width)));
    const int newHeight = std::max(1, static_cast<int>(std::lround(ratio * image.height)));
    return downscaled(image, newWidth, newHeight);
}

/// The label, shortened in the middle where it would run into the next cell.
std::string shortened(const std::string& label, int width, int scale)
{
    std::string result = label;
    for (std::size_t kept = label.size(); kept > 2 && textWidth(result, scale) > width;) {
        --kept;
        result = label.substr(0, kept / 2) + ".." + label.substr(label.size() - (kept - kept / 2));
    }
    return result;
}

}  // namespace

Image makeContactSheet(const std::vector<LabelledImage>& pictures, const SheetLayout& layout)
{
    if (pictures.empty()) throw Error(ErrorKind::usage, "a contact sheet needs a picture");
    SCREE_CHECK(
        layout.columns >= 1 && layout.cellWidth >= 1 && layout.gap >= 0 && layout.labelScale >= 1,
        "layout of a contact sheet");

    // Measure the grid.
    const Image& model = pictures.front().image;
    const int cellWidth = std::min(layout.cellWidth, model.width);
    const int cellHeight =
        std::max<int>(1, std::lround(static_cast<double>(cellWidth) * model.height / model.width));
    const int labelHeight = kTextHeight * layout.labelScale + layout.gap / 2;
    const int count = static_cast<int>(pictures.size());
    const int columns = std::min(layout.columns, count);
    const int rows = (count + columns - 1) / columns;
    const int pitchX = cellWidth + layout.gap, pitchY = cellHeight + labelHeight + layout.gap;

    // Fill it: the picture in the middle of its cell, the label below at the left.
    Image sheet(columns * pitchX + layout.gap, rows * pitchY + layout.gap, kPaper);
    for (int i = 0; i < count; ++i) {
        const int left = layout.gap + i % columns * pitchX, top = layout.gap + i / columns * pitchY;
        const Image small = fitted(pictures[i].image, cellWidth, cellHeight);
        paste(sheet, small, left + (cellWidth - small.width) / 2,
              top + (cellHeight - small.height) / 2);
        const std::string label = shortened(pictures[i].label, cellWidth, layout.labelScale);
        drawText(sheet, left, top + cellHeight + layout.gap / 2, layout.labelScale, label, kInk);
    }
    return sheet;
}

}  // namespace scree
