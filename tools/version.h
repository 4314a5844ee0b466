// Which program this is.
#pragma once

#include <string>

namespace scree {

/// "0.1.0": what a take remembers.
std::string programVersion();

/// The version, how it was built and the libraries it stands on, several lines.
std::string describeBuild();

}  // namespace scree
