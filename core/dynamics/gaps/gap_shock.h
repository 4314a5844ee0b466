// The two passes along the levels of method `scree`: weight downward, shock upward.
// [GBF03 “Shock Propagation”], [A45–A47; algorithm 14.1]
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Impulses for islands that remember none, level by level from the top: what rests is held up by
/// what is below as if that could not give way, and hands its weight down. Exact for a stack, and a
/// beginning for a heap. Velocities must have felt forces and no contact yet.
void handWeightDown(double dt, const GapBlock& block, GapScratch& scratch);

/// One sweep up the levels of a block: what rests is made to rest on what is below as if that could
/// not give way. Only where solved velocities would still overlap bodies visibly: of a level those
/// clusters, connected by bodies that are not pinned, in which one does.
/// The impulses that rows remember stay those of the symmetric problem: begun from shock's, the
/// next step of a heap blew up.
void propagateShockUp(const World& world, double dt, const GapBlock& block, GapScratch& scratch);

}  // namespace scree
