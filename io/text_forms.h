// Text in other forms, for names and messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace scree {

/// ASCII letters in small.
std::string inSmallLetters(std::string text);

/// By which the format of a file is known: "png" of "a/B.PNG"; empty where there is none.
std::string endingOf(const std::filesystem::path& file);

/// Cut to at most that many bytes, the last three of which say so: between characters of UTF-8, not
/// inside one.
std::string shortened(const std::string& text, std::size_t longest);

/// One or two numbers in a short phrase, in the format of printf.
std::string formatted(const char* format, double a, double b = 0.0);

/// "0.15 %", "13 %" or "250 %" of a share.
std::string percent(double share);

/// Sixteen digits.
std::string toHex(std::uint64_t value);

}  // namespace scree
