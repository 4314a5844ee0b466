#include "core/dynamics/gap_blocks.h"

namespace scree {
namespace {

/// A block is closed when it has so many rows, half a megabyte of them; all together are one block
/// as long as they are not more than a few caches hold. Only time depends on them.
constexpr std::size_t kRowsOfABlock = 2000, kRowsInTheCache = 10000;

void placeBodies(GapBlock& block, GapScratch& scratch)
{
    for (const std::size_t i : block.pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
            if (scratch.bodies[body].inverseMass == 0.0 || scratch.placeInBlock[body] > 0) continue;
            block.bodies.push_back(body);
            scratch.placeInBlock[body] = static_cast<std::int32_t>(block.bodies.size());
        }
    }
}

}  // namespace

void layBlocks(GapScratch& scratch)
{
    const bool isOne = scratch.openRowCount <= kRowsInTheCache;
    scratch.blocks.clear();
    std::vector<std::size_t> blockOf(scratch.islands.size());
    bool isOpen = false;
    for (const std::size_t i : scratch.openIslands) {
        if (!isOpen) scratch.blocks.emplace_back();
        GapBlock& block = scratch.blocks.back();
        block.islands.push_back(i);
        block.rowCount += scratch.islands[i].rowCount;
        blockOf[i] = scratch.blocks.size() - 1;
        isOpen = isOne || block.rowCount < kRowsOfABlock;
    }
    for (std::size_t i = 0; i < scratch.pairs.size(); ++i) {
        GapPair& pair = scratch.pairs[i];
        if (scratch.islands[pair.island].isKept) continue;
        std::vector<std::size_t>& pairs = scratch.blocks[blockOf[pair.island]].pairs;
        pair.place = pairs.size();
        pairs.push_back(i);
    }
    scratch.placeInBlock.assign(scratch.bodies.size(), 0);
    for (GapBlock& block : scratch.blocks) placeBodies(block, scratch);
}

}  // namespace scree
