// All keys of the shot file as one page: shots/REFERENCE.md is this text.
#pragma once

#include <string>

namespace scree {

/// Markdown, made from the schema alone: a section for each table, a line for each key with what it
/// must be, its unit, default and meaning.
std::string shotReference();

}  // namespace scree
