// What of a step of method `scree` is solved in one go, from rows to velocities.
//
// A step passes over its rows a dozen times. Those of ten heaps of a thousand rings fit into no
// cache, and were fetched from memory by each pass. Islands share no movable body: each may be
// solved to the end before the next is begun, or many at once without meeting in between. Impacts
// of ten such heaps take a fifth less time so; sweeps have their own layout and gain nothing.
#pragma once

#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Gathers the islands that are not kept into blocks, in their order: large ones by themselves.
/// Bits depend on none of it.
void layBlocks(GapScratch& scratch);

/// Calls work(block) for all blocks. One that is most of all rows, and few, share their loops with
/// all threads; many are worked on at once, each by one.
template <class Work>
void forBlocks(GapScratch& scratch, const Work& work)
{
    constexpr std::size_t kBlocksPerThread = 2;
    std::vector<GapBlock>& blocks = scratch.blocks;
    const bool areFew = blocks.size() < kBlocksPerThread * threadCount();
    const auto isShared = [&](const GapBlock& block) {
        return areFew || 2 * block.rowCount >= scratch.openRowCount;
    };
    for (GapBlock& block : blocks) {
        if (isShared(block)) work(block);
    }
    forEach(blocks.size(), 1, [&](std::size_t i) {
        if (!isShared(blocks[i])) work(blocks[i]);
    });
}

}  // namespace scree
