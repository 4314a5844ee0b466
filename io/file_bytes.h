// Whole files, in and out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace scree {

/// Throws Error{missingInput} when the file cannot be opened, Error{inputOutput} when reading
/// fails.
std::string readFileBytes(const std::filesystem::path& path);

/// Why the system does not tell whether anything stands under that name ("Permission denied", "File
/// name too long"); empty when it does.
std::string obstacleTo(const std::filesystem::path& path);

/// Through AtomicFile: complete or not at all.
void writeFileBytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace scree
