#include "core/geometry/distance_nodes.h"

namespace scree {
namespace {

/// Trilinear between corner[0], corner[nx], … at a place within 0 … 1 along each axis.
double betweenCorners(const float* corner, std::size_t dx, std::size_t dy, std::size_t dz,
                      const Vec3& f)
{
    const auto alongX = [&](std::size_t offset) {
        const double a = corner[offset], b = corner[offset + dx];
        return a + f.x() * (b - a);
    };
    const double y0 = alongX(0) + f.y() * (alongX(dy) - alongX(0));
    const double y1 = alongX(dz) + f.y() * (alongX(dz + dy) - alongX(dz));
    return y0 + f.z() * (y1 - y0);
}

}  // namespace

double DistanceNodes::interpolate(const Vec3& pointInside) const
{
    const Place place = placeOf(pointInside);
    const auto [i, j, k] = place.cell;
    if (storage == FieldStorage::dense) {
        const std::size_t nx = layout.count[0], nxy = nx * layout.count[1];
        return betweenCorners(values.data() + i + nx * j + nxy * k, 1, nx, nxy, place.fraction);
    }
    const FieldBlock& block = blockOf(place.cell);
    const float* first = values.data() + block.first;
    const std::array<int, 3> inBlock = {i % kBlockCells, j % kBlockCells, k % kBlockCells};
    if (!block.isCoarse) {
        constexpr std::size_t n = kBrickNodes;
        return betweenCorners(first + inBlock[0] + n * (inBlock[1] + n * inBlock[2]), 1, n, n * n,
                              place.fraction);
    }
    const std::array<int, 3> cells = cellsOfBlock(layout, blockAt(blockIndex(place.cell)));
    Vec3 fraction;
    for (int axis = 0; axis < 3; ++axis) {
        fraction[axis] = (inBlock[axis] + place.fraction[axis]) / cells[axis];
    }
    return betweenCorners(first, 1, 2, 4, fraction);
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

DistanceNodes emptyNodes(const NodeLayout& layout, FieldStorage storage)
{
    DistanceNodes nodes;
    nodes.layout = layout;
    nodes.storage = storage;
    for (int axis = 0; axis < 3; ++axis) {
        nodes.blockCount[axis] = (layout.count[axis] - 2) / kBlockCells + 1;
    }
    nodes.blocks.resize(static_cast<std::size_t>(nodes.blockCount[0]) * nodes.blockCount[1] *
                        nodes.blockCount[2]);
    return nodes;
}

}  // namespace scree
