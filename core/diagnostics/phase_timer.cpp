#include "core/diagnostics/phase_timer.h"

#include <numeric>

namespace scree {

void addShares(double wall, const std::vector<PhaseSeconds>& ofParts, PhaseSeconds& seconds)
{
    PhaseSeconds sums{};
    for (const PhaseSeconds& part : ofParts) {
        for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += part[p];
    }
    const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
    if (all == 0.0) return;
    for (std::size_t p = 0; p < sums.size(); ++p) seconds[p] += wall * sums[p] / all;
}

}  // namespace scree
