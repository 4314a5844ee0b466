#include "core/dynamics/gaps/gap_report.h"

#include <algorithm>

#include "core/dynamics/gaps/gap_levels.h"

namespace scree {

void describeGaps(const GapScratch& scratch, StepReport& report)
{
    report.broadPairs = static_cast<std::int64_t>(scratch.nearPairs.size());
    report.touchingPairs = static_cast<std::int64_t>(scratch.pairs.size());
    report.contacts = static_cast<std::int64_t>(scratch.rowCount);
    for (const GapPair& pair : scratch.pairs) {
        report.contactPairs += pair.bearing > 0;
        report.levels = std::max(report.levels, levelOf(scratch.levels, pair.bodies) + 1);
    }
    std::vector<int> bodies(static_cast<std::size_t>(report.levels), 0);
    for (std::size_t b = 0; b < scratch.bodies.size(); ++b) {
        const int level = scratch.levels.level[b];
        if (level > 0 && scratch.bodies[b].isMovable())
            report.largestLevel = std::max(report.largestLevel, ++bodies[level]);
    }
}

StepSeen seeGaps(const World& world, const GapScratch& scratch, double dt)
{
    StepSeen step;
    step.dt = dt;
    const std::vector<int>& levels = scratch.levels.level;
    step.level.assign(levels.begin(), levels.end());
    step.overlap.assign(levels.size(), 0.0);
    std::vector<Vec3> blows(scratch.rows.size(), Vec3::Zero());
    for (const GapImpact& impact : scratch.impacts) blows[impact.row] += impact.impulse;
    for (const GapPair& pair : scratch.pairs) {
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            const GapRow& row = scratch.rows[r];
            step.deepen(row.a, row.b, -row.gap);
            const Vec3 impulse = row.worldImpulse() + blows[r];
            if (impulse.isZero(0.0)) continue;
            step.contacts.push_back(
                {row.a, row.b, world.motion[row.a].position + row.rA, row.normal, impulse});
        }
    }
    return step;
}

}  // namespace scree
