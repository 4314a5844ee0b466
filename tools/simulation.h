// Simulating a shot into a take, for those commands that need more than `scree sim`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/import_limits.h"
#include "tools/console.h"

namespace scree {

struct SimOptions {
    std::string shot, take, frames, from, progress = "auto";
    std::optional<int> threads;
    bool resume = false, overwrite = false, noCache = false;
    bool printsTake = true;  ///< on stdout, at the end
    std::vector<std::string> overrides;
    ImportLimits importLimits;
};

/// One run of `scree sim`, from the first missing frame to the last; returns its exit code. Throws
/// Error for what ends it before.
int simulate(const SimOptions& options, Console& console);

}  // namespace scree
