// Whole files, in and out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace scree {

/// Throws Error{missingInput} when the file cannot be opened, Error{inputOutput} when reading
/// fails.
std::string readFileBytes(const std::filesystem::path& path);

/// Whether something stands under that name. One that may not be looked at counts as absent: its
/// folder cannot be written to either, and whoever tries says so.
bool isThere(const std::filesystem::path& path);

/// Why nothing can be read under that name, whatever stands there: the system does not tell
/// ("Permission denied", "File name too long"), or it is a pipe or a device, whose reader may wait
/// for ever. Empty when there is a file, a folder or nothing.
std::string obstacleTo(const std::filesystem::path& path);

/// Through AtomicFile: complete or not at all.
void writeFileBytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace scree
