#include "core/geometry/distance_nodes.h"

namespace scree {

DistanceNodes::BrickCorners DistanceNodes::cornersInBrick(const Place& place) const
{
    const auto [i, j, k] = place.cell;
    const FieldBlock& block = blockOf(place.cell);
    const float* first = values.data() + block.first;
    const std::array<int, 3> inBlock = {i % kBlockCells, j % kBlockCells, k % kBlockCells};
    if (!block.isCoarse) {
        constexpr std::size_t n = kBrickNodes;
        first += inBlock[0] + n * (inBlock[1] + n * inBlock[2]);
        return {first, 1, n, n * n, place.fraction, Vec3::Ones()};
    }
    const std::array<int, 3> cells = cellsOfBlock(layout, blockAt(blockIndex(place.cell)));
    BrickCorners corners{first, 1, 2, 4, {}, Vec3(cells[0], cells[1], cells[2])};
    for (int axis = 0; axis < 3; ++axis) {
        corners.fraction[axis] = (inBlock[axis] + place.fraction[axis]) / cells[axis];
    }
    return corners;
}

double DistanceNodes::interpolateInBrick(const Place& place) const
{
    const BrickCorners c = cornersInBrick(place);
    return betweenCorners(c.first, c.dx, c.dy, c.dz, c.fraction);
}

Vec3 DistanceNodes::slopeInCell(const Place& place) const
{
    if (storage != FieldStorage::dense) {
        const BrickCorners c = cornersInBrick(place);
        return slopeBetweenCorners(c.first, c.dx, c.dy, c.dz, c.fraction).cwiseQuotient(c.cells) /
               layout.spacing;
    }
    const auto [i, j, k] = place.cell;
    const std::size_t nx = layout.count[0], nxy = nx * layout.count[1];
    return slopeBetweenCorners(values.data() + i + nx * j + nxy * k, 1, nx, nxy, place.fraction) /
           layout.spacing;
}

double DistanceNodes::interpolateCoarse(std::size_t block, const std::array<int, 3>& node) const
{
    const std::array<int, 3> at = blockAt(block), cells = cellsOfBlock(layout, at);
    Vec3 fraction;
    for (int axis = 0; axis < 3; ++axis) {
        fraction[axis] = static_cast<double>(node[axis] - kBlockCells * at[axis]) / cells[axis];
    }
    return betweenCorners(values.data() + blocks[block].first, 1, 2, 4, fraction);
}

std::array<int, 3> cellsOfBlock(const NodeLayout& layout, const std::array<int, 3>& block)
{
    std::array<int, 3> cells;
    for (int axis = 0; axis < 3; ++axis) {
        cells[axis] = std::min(kBlockCells, layout.count[axis] - 1 - kBlockCells * block[axis]);
    }
    return cells;
}

std::array<int, 3> blocksAlong(const NodeLayout& layout)
{
    std::array<int, 3> blocks;
    for (int axis = 0; axis < 3; ++axis) blocks[axis] = (layout.count[axis] - 2) / kBlockCells + 1;
    return blocks;
}

DistanceNodes emptyNodes(const NodeLayout& layout, FieldStorage storage)
{
    DistanceNodes nodes;
    nodes.layout = layout;
    nodes.storage = storage;
    nodes.blockCount = blocksAlong(layout);
    nodes.blocks.resize(static_cast<std::size_t>(nodes.blockCount[0]) * nodes.blockCount[1] *
                        nodes.blockCount[2]);
    return nodes;
}

}  // namespace scree
