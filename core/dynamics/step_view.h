// What an observer is shown of a step of method `paper`, gathered from its scratch.
#pragma once

#include "core/diagnostics/step_observer.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/scratch.h"

namespace scree {

/// Notes an impulse of one visit. Visits of the same sample add up: the passes come to a contact
/// many times. Only its pair's worker calls it, so the order is that of the pair's own visits.
void showImpulse(PairRecord& pair, std::int32_t sample, bool sampleOnA, const ContactSeen& seen);

/// After push-out.
StepSeen seePairs(const StepScratch& scratch, const GraphLevels& levels, double dt);

}  // namespace scree
