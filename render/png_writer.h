// Image ⇄ PNG files: 8 bits a channel, marked as sRGB.
#pragma once

#include <cstdint>
#include <filesystem>
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

/// Writes the picture so that `path` is at every instant either what it was before or complete: to
/// a temporary name in the same folder, synced, renamed. Throws Error{cannotCreate} when the
/// temporary file or the renaming is refused, Error{inputOutput} when writing fails half way.
void writePng(const std::filesystem::path& path, const Image& image, const PngText& text = {});

/// Reads any PNG; alpha is ignored, 16 bits are cut to 8. Throws Error{missingInput} when there is
/// no such file and Error{inputOutput} when it is no readable PNG.
PngContents readPng(const std::filesystem::path& path);

/// Reads all of the file and keeps nothing: throws as readPng does.
void requireWholePng(const std::filesystem::path& path);

}  // namespace scree
