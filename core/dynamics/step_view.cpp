#include "core/dynamics/step_view.h"

#include <algorithm>

namespace scree {
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
        if (pair.isTouched) step.deepen(pair.bodies.a, pair.bodies.b, pair.depth);
    }
    return step;
}

}  // namespace scree
