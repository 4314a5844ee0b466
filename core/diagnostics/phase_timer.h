// Wall time by phase.
#pragma once

#include <chrono>
#include <vector>

#include "core/diagnostics/step_report.h"

namespace scree {

class Stopwatch {
public:
    /// Since it was made [s].
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Adds the wall time of a scope to one phase.
class PhaseTimer {
public:
    PhaseTimer(PhaseSeconds& seconds, Phase phase) : seconds_(seconds[static_cast<int>(phase)]) {}
    ~PhaseTimer() { seconds_ += watch_.seconds(); }
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

private:
    double& seconds_;
    Stopwatch watch_;
};

/// Shares a wall time [s] among the phases of the parts that ran in it, several at once: each phase
/// gets as much of it as it had of the time the parts took together.
void addShares(double wall, const std::vector<PhaseSeconds>& ofParts, PhaseSeconds& seconds);

}  // namespace scree
