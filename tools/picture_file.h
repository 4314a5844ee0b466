// Pictures as files: render knows what a PNG is, io how a file is written.
#pragma once

#include <filesystem>

#include "render/png_writer.h"

namespace scree {

/// Complete or not at all: throws Error{cannotCreate} when no file can be made there,
/// Error{inputOutput} when the disk refuses.
void writePng(const std::filesystem::path& path, const Image& image, const PngText& text = {});

/// Throws Error{missingInput} when the file cannot be opened, Error{inputOutput} when it is no
/// readable PNG.
PngContents readPng(const std::filesystem::path& path);

/// Reads all of the file and keeps nothing: throws as readPng does.
void requireWholePngFile(const std::filesystem::path& path);

}  // namespace scree
