// Text on HTML and SVG pages.
#pragma once

#include <string>

namespace scree {

/// Reads as itself between tags and in quoted attributes.
std::string escapedForHtml(const std::string& text);

}  // namespace scree
