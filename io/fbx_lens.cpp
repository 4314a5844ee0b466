#include "io/fbx_lens.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>

namespace scree {
namespace {

/// The text at the front of `rest`, as binary files have it: a letter, a length, the letters.
bool skipText(std::string_view& rest)
{
    std::uint32_t length = 0;
    if (!rest.starts_with('S') || rest.size() < 1 + sizeof length) return false;
    std::memcpy(&length, rest.data() + 1, sizeof length);
    rest.remove_prefix(1 + sizeof length);
    if (length > rest.size()) return false;
    rest.remove_prefix(length);
    return true;
}

/// The number of a binary property, after its name: two words, flags, a number.
std::optional<double> binaryNumber(std::string_view rest)
{
    for (int i = 0; i < 3; ++i)
        if (!skipText(rest)) return std::nullopt;
    double asDouble = 0.0;
    float asFloat = 0.0f;
    if (rest.starts_with('D') && rest.size() > sizeof asDouble) {
        std::memcpy(&asDouble, rest.data() + 1, sizeof asDouble);
        return asDouble;
    }
    if (rest.starts_with('F') && rest.size() > sizeof asFloat) {
        std::memcpy(&asFloat, rest.data() + 1, sizeof asFloat);
        return asFloat;
    }
    return std::nullopt;
}

/// The number of a property in words: the last of its line.
std::optional<double> writtenNumber(std::string_view rest)
{
    const std::string line(rest.substr(0, rest.find_first_of("\r\n")));
    const std::size_t comma = line.rfind(',');
    if (comma == std::string::npos) return std::nullopt;
    const char* begin = line.c_str() + comma + 1;
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    return end == begin ? std::nullopt : std::optional(value);
}

/// All that objects have of a property; what the file defines for those without is not theirs.
std::set<double> valuesOf(const std::string& name, std::string_view bytes)
{
    const std::size_t objects = std::min(bytes.find("\nObjects:"), bytes.find("\x07Objects"));
    if (objects == std::string_view::npos) return {};
    bytes.remove_prefix(objects);
    std::set<double> values;
    const std::string quoted = "\"" + name + "\"";
    for (std::size_t at = bytes.find(quoted); at != std::string_view::npos;
         at = bytes.find(quoted, at + 1))
        if (const auto value = writtenNumber(bytes.substr(at))) values.insert(*value);
    std::string stored = "S";
    const auto length = static_cast<std::uint32_t>(name.size());
    stored.append(reinterpret_cast<const char*>(&length), sizeof length);
    stored += name;
    for (std::size_t at = bytes.find(stored); at != std::string_view::npos;
         at = bytes.find(stored, at + 1))
        if (const auto value = binaryNumber(bytes.substr(at + stored.size())))
            values.insert(*value);
    return values;
}

}  // namespace

FbxLens readFbxLens(const std::string& bytes)
{
    constexpr double kMillimetres = 25.4;  // of an inch, in which films are measured
    FbxLens lens;
    lens.hasOneDegree = valuesOf("FieldOfView", bytes).contains(1.0);
    const std::set<double> widths = valuesOf("FilmWidth", bytes);
    const std::set<double> focalLengths = valuesOf("FocalLength", bytes);
    if (widths.size() != 1 || focalLengths.size() != 1) return lens;
    const double tangent = 0.5 * kMillimetres * *widths.begin() / *focalLengths.begin();
    if (std::isfinite(tangent) && tangent > 0.0) lens.halfTangent = tangent;
    return lens;
}

}  // namespace scree
