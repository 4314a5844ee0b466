// Text on HTML and SVG pages, and pictures inside them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// Reads as itself between tags and in quoted attributes.
std::string escapedForHtml(const std::string& text);

/// Base64 with padding [RFC 4648].
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace scree
