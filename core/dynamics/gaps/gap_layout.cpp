#include "core/dynamics/gaps/gap_layout.h"

#include "core/dynamics/gaps/gap_blocks.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_pairs.h"
#include "core/dynamics/gaps/gap_search.h"

namespace scree {

void layOutGaps(World& world, const StepSettings& settings, double dt, const SolvedIslands& solved,
                GapScratch& scratch)
{
    if (solved.isNone())
        findGaps(world, settings, dt, scratch);
    else
        findGapsAgain(world, dt, scratch);
    layPairs(world, scratch);
    solved.handOn(scratch);
    orderPairs(world, scratch);
    layBlocks(scratch);
    levelOthers(scratch);
}

}  // namespace scree
