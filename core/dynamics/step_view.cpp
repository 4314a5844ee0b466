#include "core/dynamics/step_view.h"

#include <algorithm>

namespace scree {
namespace {

/// Both bodies of a pair are as deep as the pair is.
void deepen(StepSeen& step, BodyId a, BodyId b, double depth)
{
    for (const BodyId body : {a, b}) step.overlap[body] = std::max(step.overlap[body], depth);
}

}  // namespace

void showImpulse(PairRecord& pair, std::int32_t sample, bool sampleOnA, const ContactSeen& seen)
{
    const auto known = std::find_if(
        pair.impulses.begin(), pair.impulses.end(), [&](const PairRecord::NotedImpulse& noted) {
            return noted.sample == sample && noted.sampleOnA == sampleOnA;
        });
    if (known == pair.impulses.end()) {
        pair.impulses.push_back({sample, sampleOnA, seen});
        return;
    }
    // The last visit knows best where the bodies touch.
    const Vec3 sum = known->seen.impulse + seen.impulse;
    known->seen = seen;
    known->seen.impulse = sum;
}

StepSeen seePairs(const StepScratch& scratch, const GraphLevels& levels, double dt)
{
    StepSeen step;
    step.dt = dt;
    step.level.assign(levels.level.begin(), levels.level.end());
    step.overlap.assign(levels.level.size(), 0.0);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        const PairRecord& pair = scratch.pairs[i];
        for (const PairRecord::NotedImpulse& noted : pair.impulses)
            step.contacts.push_back(noted.seen);
        if (pair.isTouched) deepen(step, pair.bodies.a, pair.bodies.b, pair.depth);
    }
    return step;
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
            deepen(step, row.a, row.b, -row.gap);
            const Vec3 impulse = row.worldImpulse() + blows[r];
            if (impulse.isZero(0.0)) continue;
            step.contacts.push_back(
                {row.a, row.b, world.motion[row.a].position + row.rA, row.normal, impulse});
        }
    }
    return step;
}

}  // namespace scree
