// What an observer is shown of a step, gathered from the scratch of either method.
#pragma once

#include "core/diagnostics/step_observer.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/gap_scratch.h"
#include "core/dynamics/scratch.h"

namespace scree {

/// Notes an impulse of one visit. Visits of the same sample add up: the passes come to a contact
/// many times. Only its pair's worker calls it, so the order is that of the pair's own visits.
void showImpulse(PairRecord& pair, std::int32_t sample, bool sampleOnA, const ContactSeen& seen);

/// Method `paper`, after push-out.
StepSeen seePairs(const StepScratch& scratch, const GraphLevels& levels, double dt);

/// Method `scree`, before bodies have moved: rows measure their points from where these are.
StepSeen seeGaps(const World& world, const GapScratch& scratch, double dt);

}  // namespace scree
