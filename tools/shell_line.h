// Commands as they would be typed, for messages that say what to run.
#pragma once

#include <string>
#include <vector>

namespace scree {

/// The words in one line that a shell takes apart into the same words.
std::string shellLine(const std::vector<std::string>& words);

}  // namespace scree
