#include "tools/picture_file.h"

#include "io/byte_order.h"
#include "io/file_bytes.h"

namespace scree {
namespace {

std::span<const std::uint8_t> octetsOf(const std::string& bytes)
{
    return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace

void writePng(const std::filesystem::path& path, const Image& image, const PngText& text)
{
    writeFileBytes(path, bytesOf(encodePng(image, text)));
}

PngContents readPng(const std::filesystem::path& path)
{
    const std::string bytes = readFileBytes(path);
    return decodePng(octetsOf(bytes), path.string());
}

void requireWholePngFile(const std::filesystem::path& path)
{
    const std::string bytes = readFileBytes(path);
    requireWholePng(octetsOf(bytes), path.string());
}

}  // namespace scree
