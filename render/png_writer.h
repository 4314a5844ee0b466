// Image ⇄ the bytes of a PNG file: 8 bits a channel, marked as sRGB. This room opens no file; who
// has one hands its bytes over.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/image.h"

namespace scree {

/// Keyword and value; a keyword has 1 … 79 printable ASCII characters. Values that are not ASCII
/// are taken as UTF-8.
using PngText = std::vector<std::pair<std::string, std::string>>;

/// What a PNG file holds.
struct PngContents {
    Image image;
    PngText text;
};

/// The bytes of a PNG file. Equal pictures and texts give equal bytes.
std::vector<std::uint8_t> encodePng(const Image& image, const PngText& text = {});

/// Reads any PNG; alpha is ignored, 16 bits are cut to 8. Throws Error{inputOutput}, which calls
/// the file by `name`, when the bytes are no readable PNG.
PngContents decodePng(std::span<const std::uint8_t> bytes, const std::string& name);

/// Reads all of it and keeps nothing: throws as decodePng does.
void requireWholePng(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace scree
