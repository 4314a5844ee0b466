#include "io/frame_pattern.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/base/error.h"

namespace scree {

namespace {

/// Where a pattern stands in the path, and how many digits it asks for.
struct Place {
    std::size_t begin, length;
    std::size_t width;
};

constexpr std::size_t kMostDigits = 20;

bool isDigit(char letter)
{
    return letter >= '0' && letter <= '9';
}

/// "####": as many digits as signs.
Place matchHashes(std::string_view path, std::size_t begin)
{
    std::size_t end = begin;
    while (end < path.size() && path[end] == '#') ++end;
    return {begin, end - begin, end - begin};
}

/// The number that stands at `cursor`, which is moved behind it; 0 without digits.
std::size_t readWidth(std::string_view path, std::size_t& cursor)
{
    std::size_t width = 0;
    for (; cursor < path.size() && isDigit(path[cursor]); ++cursor) {
        width = std::min(width * 10 + static_cast<std::size_t>(path[cursor] - '0'), kMostDigits);
    }
    return width;
}

/// "%04d" or "%d"; length 0 when it is something else.
Place matchPercent(std::string_view path, std::size_t begin)
{
    std::size_t cursor = begin + 1;
    const std::size_t width = readWidth(path, cursor);
    if (cursor >= path.size() || path[cursor] != 'd') return {begin, 0, 0};
    return {begin, cursor + 1 - begin, width};
}

/// "$F4" or "$F".
Place matchDollar(std::string_view path, std::size_t begin)
{
    if (path.substr(begin, 2) != "$F") return {begin, 0, 0};
    std::size_t cursor = begin + 2;
    const std::size_t width = readWidth(path, cursor);
    return {begin, cursor - begin, width};
}

std::vector<Place> findPlaces(std::string_view path)
{
    std::vector<Place> places;
    const std::size_t slash = path.rfind('/');
    std::size_t cursor = slash == std::string_view::npos ? 0 : slash + 1;
    while (cursor < path.size()) {
        Place place = {cursor, 0, 0};
        if (path[cursor] == '#') place = matchHashes(path, cursor);
        if (path[cursor] == '%') place = matchPercent(path, cursor);
        if (path[cursor] == '$') place = matchDollar(path, cursor);
        if (place.length > 0) places.push_back(place);
        cursor += place.length > 0 ? place.length : 1;
    }
    return places;
}

std::string withDigits(int frame, std::size_t width)
{
    const std::string sign = frame < 0 ? "-" : "";
    std::string digits = std::to_string(frame).substr(sign.size());
    const std::size_t written = sign.size() + digits.size();
    if (written < width) digits.insert(0, width - written, '0');
    return sign + digits;
}

/// What the user should have written: "x.obj" → "x.####.obj".
std::string suggestion(std::string_view path)
{
    const std::filesystem::path name(path);
    return (name.parent_path() / (name.stem().string() + ".####" + name.extension().string()))
        .string();
}

}  // namespace

bool hasFramePattern(std::string_view path)
{
    return !findPlaces(path).empty();
}

std::string expandFramePattern(std::string_view path, int frame)
{
    const std::vector<Place> places = findPlaces(path);
    const std::string quoted = "\"" + std::string(path) + "\"";
    if (places.empty()) {
        throw Error(ErrorKind::usage,
                    "the file name " + quoted + " has no place for the frame number; write \"" +
                        suggestion(path) + "\" (%04d and $F4 are understood too)");
    }
    if (places.size() > 1) {
        throw Error(ErrorKind::usage, "the file name " + quoted +
                                          " has several places for the frame number; leave one");
    }
    const Place& place = places.front();
    return std::string(path.substr(0, place.begin)) + withDigits(frame, place.width) +
           std::string(path.substr(place.begin + place.length));
}

SplitPattern splitFramePattern(std::string_view path)
{
    // Two numbers without a digit in common show where the place is.
    const std::string ones = expandFramePattern(path, 111111111);
    const std::string twos = expandFramePattern(path, 222222222);
    std::size_t begin = 0, end = ones.size();
    while (ones[begin] == twos[begin]) ++begin;
    while (ones[end - 1] == twos[end - 1]) --end;
    const SplitPattern split = {ones.substr(0, begin), ones.substr(end), 0};
    const std::size_t rest = split.head.size() + split.tail.size();
    return {split.head, split.tail, expandFramePattern(path, 0).size() - rest};
}

std::optional<int> frameOf(std::string_view pattern, std::string_view name)
{
    const std::vector<Place> places = findPlaces(pattern);
    if (places.size() != 1) return {};
    const std::string_view before = pattern.substr(0, places[0].begin);
    const std::string_view after = pattern.substr(places[0].begin + places[0].length);
    if (name.size() <= before.size() + after.size()) return {};
    const std::string_view number =
        name.substr(before.size(), name.size() - before.size() - after.size());
    int frame = 0;
    const char* const end = number.data() + number.size();
    const auto [read, error] = std::from_chars(number.data(), end, frame);
    if (error != std::errc() || read != end || expandFramePattern(pattern, frame) != name)
        return {};
    return frame;
}

std::string framePath(std::string_view path, int frame)
{
    return hasFramePattern(path) ? expandFramePattern(path, frame) : std::string(path);
}

}  // namespace scree
