#include "core/dynamics/gaps/gap_blocks.h"

namespace scree {
namespace {

/// Another block at the end of those in use; those of earlier steps keep their memory.
void openBlock(std::size_t& used, std::vector<GapBlock>& blocks)
{
    if (used == blocks.size()) blocks.emplace_back();
    GapBlock& block = blocks[used++];
    block.islands.clear();
    block.pairs.clear();
    block.bodies.clear();
    block.rowCount = 0;
    block.impacts.clear();
    block.isAtItsCap = false;
}

/// A block is closed when it has so many rows, half a megabyte of them; all together are one block
/// as long as they are not more than a few caches hold. Only time depends on them.
constexpr std::size_t kRowsOfABlock = 2000, kRowsInTheCache = 10000;

void placeBodies(GapBlock& block, GapScratch& scratch)
{
    for (const std::size_t i : block.pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
            if (!scratch.bodies[body].isMovable() || scratch.placeInBlock[body] > 0) continue;
            block.bodies.push_back(body);
            scratch.placeInBlock[body] = static_cast<std::int32_t>(block.bodies.size());
        }
    }
}

}  // namespace

void layBlocks(GapScratch& scratch)
{
    const bool isOne = scratch.openRowCount <= kRowsInTheCache;
    std::size_t used = 0;
    std::vector<std::size_t> blockOf(scratch.islands.size());
    bool isOpen = false;
    for (const std::size_t i : scratch.openIslands) {
        if (!isOpen) openBlock(used, scratch.blocks);
        GapBlock& block = scratch.blocks[used - 1];
        block.islands.push_back(i);
        block.rowCount += scratch.islands[i].rowCount;
        blockOf[i] = used - 1;
        isOpen = isOne || block.rowCount < kRowsOfABlock;
    }
    scratch.blocks.resize(used);
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
