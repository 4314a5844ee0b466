// Signed distances at the nodes of a lattice, in one of two storages behind one interface.  [A4,
// A10, A11]
//
// Both are cut into blocks of 8 × 8 × 8 cells that know the lowest and highest value in them, so
// that a question about the sign ends at the block wherever the surface is far. `dense` keeps every
// node: one multiplication finds it, and small shapes fit the cache. `bricks` keeps the nodes of
// the blocks near the surface, 9³ each so that a cell never looks into a neighbour, and of any
// other block only its eight corners: a large shape then takes the memory of its surface, not of
// its volume. Nodes that a brick shares with such a coarse block take the value interpolated there,
// so that the field has no cracks; they are at least three spacings from the surface. Nearer than
// that the two storages agree bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/aabb.h"

namespace scree {

enum class FieldStorage {
    automatic,  ///< dense while it is small, bricks where they save a quarter or more
    dense,
    bricks,
};

/// Node (i, j, k) lies at origin + spacing · (i, j, k); at least two nodes along each axis.
struct NodeLayout {
    Vec3 origin = Vec3::Zero();  ///< [m]
    double spacing = 0.0;        ///< [m]
    std::array<int, 3> count = {0, 0, 0};

    Vec3 node(int i, int j, int k) const { return origin + spacing * Vec3(i, j, k); }
    Vec3 last() const { return node(count[0] - 1, count[1] - 1, count[2] - 1); }
    std::size_t nodeCount() const
    {
        return static_cast<std::size_t>(count[0]) * count[1] * count[2];
    }
};

inline constexpr int kBlockCells = 8;                // along each axis
inline constexpr int kBrickNodes = kBlockCells + 1;  // along each axis
inline constexpr int kBrickValues = kBrickNodes * kBrickNodes * kBrickNodes;
inline constexpr double kHalfDiagonal = 0.86602540378443864676;  // of a unit cell

/// Where the interpolated value is nearer to zero than this, the mesh is asked [m]: nodes are exact
/// and distance is 1-Lipschitz, so interpolation is off by at most half a cell's diagonal
/// (signed_distance.h). One per
/// cent more covers single-precision nodes and the contour value tau.
inline double refinementBandOf(double spacing)
{
    return 1.01 * kHalfDiagonal * spacing;
}

/// Trilinear between corner[0], corner[dx], … at a place within 0 … 1 along each axis.
inline double betweenCorners(const float* corner, std::size_t dx, std::size_t dy, std::size_t dz,
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

/// How that changes from one side of the cell to the other along each axis.
inline Vec3 slopeBetweenCorners(const float* corner, std::size_t dx, std::size_t dy, std::size_t dz,
                                const Vec3& f)
{
    const auto rise = [&](std::size_t offset, std::size_t along) {
        return static_cast<double>(corner[offset + along]) - corner[offset];
    };
    const auto slope = [&](std::size_t along, std::size_t p, double fp, std::size_t q, double fq) {
        const double near = rise(0, along), far = rise(q, along);
        const double q0 = near + fp * (rise(p, along) - near);
        const double q1 = far + fp * (rise(p + q, along) - far);
        return q0 + fq * (q1 - q0);
    };
    return {slope(dx, dy, f.y(), dz, f.z()), slope(dy, dx, f.x(), dz, f.z()),
            slope(dz, dx, f.x(), dy, f.y())};
}

/// One block of cells. All of it is outside where low > 0 and inside where high < 0; only in the
/// others does a sign ask for more.
struct FieldBlock {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    float low = 0.0f, high = 0.0f;     // what interpolation in it lies between [m]
    float slack = 0.0f;                // by how much it can exceed the true distance [m]
    std::uint32_t isCoarse = 0;        // only its corners are kept
    std::uint32_t first = 0;           // of its values, where stored by blocks
    std::uint32_t candidates = kNone;  // of its cells in NearestFaces, where they have any
};

struct DistanceNodes {
    NodeLayout layout;
    FieldStorage storage = FieldStorage::dense;  // dense or bricks
    std::array<int, 3> blockCount = {0, 0, 0};
    std::vector<FieldBlock> blocks;  // x fastest
    std::vector<float> values;  // dense: every node, x fastest; bricks: of block after block [m]

    /// A cell and the place in it, each coordinate in 0 … 1.
    struct Place {
        std::array<int, 3> cell;
        Vec3 fraction;
    };

    Place placeOf(const Vec3& pointInside) const
    {
        const double inverseSpacing = 1.0 / layout.spacing;
        Place place;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = (pointInside[axis] - layout.origin[axis]) * inverseSpacing;
            place.cell[axis] = std::clamp(static_cast<int>(x), 0, layout.count[axis] - 2);
            place.fraction[axis] = x - place.cell[axis];
        }
        return place;
    }

    std::size_t blockIndex(const std::array<int, 3>& cell) const
    {
        const auto bx = static_cast<std::size_t>(blockCount[0]);
        const auto by = static_cast<std::size_t>(blockCount[1]);
        return cell[0] / kBlockCells + bx * (cell[1] / kBlockCells + by * (cell[2] / kBlockCells));
    }
    const FieldBlock& blockOf(const std::array<int, 3>& cell) const
    {
        return blocks[blockIndex(cell)];
    }

    /// Which block that is, along each axis.
    std::array<int, 3> blockAt(std::size_t index) const
    {
        const auto b = static_cast<int>(index);
        return {b % blockCount[0], b / blockCount[0] % blockCount[1],
                b / blockCount[0] / blockCount[1]};
    }

    /// Where the value of a node is kept for a block, not a coarse one, that it belongs to.
    std::size_t valueIndex(const std::array<int, 3>& node, const std::array<int, 3>& block) const
    {
        const auto [i, j, k] = node;
        if (storage == FieldStorage::dense) {
            return i + static_cast<std::size_t>(layout.count[0]) *
                           (j + static_cast<std::size_t>(layout.count[1]) * k);
        }
        const std::size_t b =
            block[0] + static_cast<std::size_t>(blockCount[0]) *
                           (block[1] + static_cast<std::size_t>(blockCount[1]) * block[2]);
        return blocks[b].first + (i - kBlockCells * block[0]) +
               kBrickNodes * ((j - kBlockCells * block[1]) +
                              kBrickNodes * static_cast<std::size_t>(k - kBlockCells * block[2]));
    }
    double nodeValue(const std::array<int, 3>& node, const std::array<int, 3>& block) const
    {
        return values[valueIndex(node, block)];
    }

    /// The trilinear value at a point of the domain [m].
    double interpolate(const Place& place) const
    {
        if (storage != FieldStorage::dense) return interpolateInBrick(place);
        const auto [i, j, k] = place.cell;
        const std::size_t nx = layout.count[0], nxy = nx * layout.count[1];
        return betweenCorners(values.data() + i + nx * j + nxy * k, 1, nx, nxy, place.fraction);
    }

    /// Gradient of the trilinear value, of the cell alone: it jumps between cells.
    Vec3 slopeInCell(const Place& place) const;

    /// What a coarse block says at a node that belongs to it [m].
    double interpolateCoarse(std::size_t block, const std::array<int, 3>& node) const;

    /// The corners that a place in a brick lies between, and where between them.
    struct BrickCorners {
        const float* first;
        std::size_t dx, dy, dz;
        Vec3 fraction;
        Vec3 cells;  // from corner to corner, along each axis
    };
    BrickCorners cornersInBrick(const Place& place) const;
    double interpolateInBrick(const Place& place) const;

    std::size_t byteCount() const
    {
        return values.size() * sizeof(float) + blocks.size() * sizeof(FieldBlock);
    }
};

/// Blocks along each axis of a lattice.
std::array<int, 3> blocksAlong(const NodeLayout& layout);

/// Cells along each axis of the block: 8 but for the last ones.
std::array<int, 3> cellsOfBlock(const NodeLayout& layout, const std::array<int, 3>& block);

/// Layout, block count and storage set; every block fine and without values.
DistanceNodes emptyNodes(const NodeLayout& layout, FieldStorage storage);

}  // namespace scree
