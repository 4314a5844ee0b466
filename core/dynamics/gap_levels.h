// Who rests on whom, told from gaps; and the two passes that use it: weight downward, shock upward.
// [GBF03 “Contact Graph”, “Shock Propagation”], [A36–A38, A45–A47; algorithm 14.1]
#pragma once

#include "core/dynamics/contact_graph.h"
#include "core/dynamics/gap_scratch.h"

namespace scree {

/// The levels of the bodies of a block, the same as those of the paper's graph. With the velocities
/// before forces. Notes who falls on whom.
void findLevels(double dt, const GapBlock& block, GapScratch& scratch);

/// The levels of all that is in no block, nor kept: nothing rests on anything.
void levelOthers(GapScratch& scratch);

/// That of its higher body.
int levelOf(const GapLevels& levels, BodyPair bodies);

/// Impulses for islands that remember none, level by level from the top: what rests is held up by
/// what is below as if that could not give way, and hands its weight down. Exact for a stack, and a
/// beginning for a heap. Velocities must have felt forces and no contact yet.
void handWeightDown(const StepSettings& settings, double dt, const GapBlock& block,
                    GapScratch& scratch);

/// One sweep up the levels of a block: what rests is made to rest on what is below as if that could
/// not give way. Only where solved velocities would still overlap bodies visibly: of a level those
/// clusters, connected by bodies that are not pinned, in which one does.
/// The impulses that rows remember stay those of the symmetric problem: begun from shock's, the
/// next step of a heap blew up.
void propagateShockUp(const World& world, const StepSettings& settings, double dt,
                      const GapBlock& block, GapScratch& scratch);

}  // namespace scree
