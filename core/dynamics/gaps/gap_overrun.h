// What would be run through before a blow comes.
//
// A body that is hit late in a step goes on until then as it did (gap_impacts.h), also if what it
// meets before has been stopped by another, or thrown back into it. No velocity is wrong then, but
// the way there is: of two cards that lay against each other one was hit, and the other, on its way
// to the floor, was half through it when the step ended.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Lets a body that is hit move with the velocities it has afterwards for the whole step.
void moveFromTheStart(GapBody& body);

/// Lets bodies that would run into others until they are hit, and would not with the velocities
/// they have afterwards, move with these from the start. After impacts; `dt` [s].  [A28]
void endOverruns(const World& world, double dt, const GapBlock& block, GapScratch& scratch);

}  // namespace scree
