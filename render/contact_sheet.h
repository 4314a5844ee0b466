// Many frames at a glance: a grid of small labelled pictures.
#pragma once

#include <string>
#include <vector>

#include "render/image.h"

namespace scree {

struct LabelledImage {
    Image image;
    std::string label;
};

/// What a contact sheet looks like. A sheet wider than a screen cannot be taken in at a glance, and
/// cells below about 160 pixels no longer show whether things overlap.
struct SheetLayout {
    int columns = 4;      ///< pictures in a row; fewer pictures make a narrower sheet
    int cellWidth = 400;  ///< of a picture [pixels]; pictures are never enlarged
    int gap = 8;          ///< between pictures and around the sheet [pixels]
    int labelScale = 2;   ///< size of a dot of the labels [pixels]
};

/// One sheet in reading order. All cells have the shape of the first picture; another picture is
/// fitted into its cell whole. Throws Error{usage} when there is no picture.
Image makeContactSheet(const std::vector<LabelledImage>& pictures, const SheetLayout& layout = {});

}  // namespace scree
