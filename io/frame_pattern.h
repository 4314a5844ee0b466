// File names with a place for the frame number: "x.####.png", "x.%04d.png" or "x.$F4.png".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scree {

/// Whether the file name (folders do not count) has a place for the frame number.
bool hasFramePattern(std::string_view path);

/// The path with the frame number in its place, filled up with zeros to the width the pattern asks
/// for; a longer number is written in full. A minus sign counts as one of the digits. Throws
/// Error{usage} when the file name has no such place or several.
std::string expandFramePattern(std::string_view path, int frame);

/// A path around the place of its number.
struct SplitPattern {
    std::string head, tail;
    std::size_t digits = 0;
};

/// Throws as expandFramePattern does.
SplitPattern splitFramePattern(std::string_view path);

/// The frame of which expandFramePattern makes the file name `name`; none if it does of no frame.
/// Neither has folders.
std::optional<int> frameOf(std::string_view pattern, std::string_view name);

/// expandFramePattern for one frame alone, whose name may do without such a place: it stays as it
/// is.
std::string framePath(std::string_view path, int frame);

}  // namespace scree
