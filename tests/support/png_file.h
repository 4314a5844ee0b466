// Pictures that tests of render leave and find again.
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "render/png_writer.h"
#include "tests/support/support.h"

namespace scree::test {

inline void storePng(const std::filesystem::path& path, const Image& image)
{
    const std::vector<std::uint8_t> bytes = encodePng(image);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

inline Image loadPng(const std::filesystem::path& path)
{
    const std::string content = contentOf(path);
    return decodePng({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()},
                     path.string())
        .image;
}

}  // namespace scree::test
