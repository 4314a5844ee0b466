// Runs work that must not be trusted in a child process with little to break: limited memory and
// processor time, no file it can write, no new privileges. What comes back is bytes; whoever asked
// validates them as he would a stranger's file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace scree {

struct ConfinedLimits {
    std::uint64_t memoryBytes = std::uint64_t{4} << 30;  ///< beyond what the parent uses
    int seconds = 60;                                    ///< of processor time
    double clockSeconds = 120.0;
    std::uint64_t resultBytes = std::uint64_t{2} << 30;
};

/// What `work` returns. Throws Error{badInput} with the message of an Error that `work` throws, and
/// with a sentence that begins with `what` when it crashes or meets a limit.
///
/// The child is a fork without exec, so `work` may use whatever the caller has built, but no lock
/// that another thread may hold and no thread pool.
std::string runConfined(const std::string& what, const std::function<std::string()>& work,
                        const ConfinedLimits& limits = {});

}  // namespace scree
