// Who rests on whom, told from gaps.  [GBF03 “Contact Graph”], [A36–A38; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// The levels of the bodies of a block, those of the paper's graph but that nothing rests on what
/// it merely leans on. With the velocities before forces. Notes who falls on whom.
void findLevels(double dt, const GapBlock& block, GapScratch& scratch);

/// The levels of all that is in no block, nor kept: nothing rests on anything.
void levelOthers(GapScratch& scratch);

/// That of its higher body.
int levelOf(const GapLevels& levels, BodyPair bodies);

}  // namespace scree
