// Symbols: h node spacing. A block is coarse when no node of it, its faces
// included, lies in OpenVDB's band.
#include "core/geometry/level_set_build.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/triangle_distance.h"
#include "core/geometry/winding_number.h"

namespace scree {
namespace {

constexpr float kBandVoxels = 3.0f;

/// Up to here a lattice is dense without asking: it fits a core's own cache [bytes].
constexpr std::size_t kSmallLattice = 2u << 20;

using Index3 = std::array<int, 3>;

openvdb::FloatGrid::Ptr narrowBand(const TriMesh& mesh, const NodeLayout& layout)
{
    openvdb::initialize();
    // Index space: one unit per node spacing, node (0, 0, 0) at the origin.
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.points.cols());
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const Vec3 p = (mesh.points.col(v) - layout.origin) / layout.spacing;
        points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
    }
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangles.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        triangles.emplace_back(mesh.triangles(0, f), mesh.triangles(1, f), mesh.triangles(2, f));
    }
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(
        points, triangles);
    const auto unitTransform = openvdb::math::Transform::createLinearTransform(1.0);
    // The same band on both sides: OpenVDB would widen the inner one from neighbour to neighbour,
    // slower than asking the mesh and not quite exact.
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *unitTransform, kBandVoxels,
                                                            kBandVoxels);
}

/// What tells the cavities of a solid from the solid; nothing when there can be none. OpenVDB
/// floods from outside, takes all that it does not reach for solid and forgets the walls inside:
/// the sand would be inside the glass of an hourglass.
std::optional<WindingNumber> sidesOf(const TriMesh& mesh)
{
    const std::vector<int> partOf = findParts(mesh);
    if (*std::max_element(partOf.begin(), partOf.end()) == 0) return std::nullopt;
    return WindingNumber(mesh);
}

/// All that a node is read from.
struct NodeSource {
    const TriMesh& mesh;
    const SurfaceRays& rays;
    openvdb::FloatGrid::Ptr band;
    std::optional<WindingNumber> sides;
    /// Set where OpenVDB says inside and the mesh does not, while there are no sides to ask: its
    /// flood does not pass a hole narrower than two voxels, and all of the bottle behind it was
    /// solid.
    mutable std::atomic<bool> isContradicted = false;
};

/// Asks OpenVDB for the side and the mesh for the distance. One for each thread.
///
/// OpenVDB's own distances are exact only up to the first nodes beside the surface: it widens the
/// band from neighbour to neighbour and smooths it, and at two spacings from a sphere was off by a
/// fifth of one. All that is said of how far interpolation can be off (signed_distance.h) rests on
/// exact nodes.
class NodeReader {
public:
    NodeReader(const NodeSource& source, const NodeLayout& layout)
        : mesh_(source.mesh),
          rays_(source.rays),
          layout_(layout),
          accessor_(source.band->getConstAccessor()),
          sides_(source.sides ? &*source.sides : nullptr),
          isContradicted_(source.isContradicted)
    {
    }

    /// Signed distance at a node. Neighbours asked one after another are found fastest: the
    /// triangle that was the closest to the last is hardly farther than that of the next.
    float read(const Index3& node)
    {
        float voxels = accessor_.getValue(openvdb::Coord(node[0], node[1], node[2]));
        const Vec3 p = layout_.node(node[0], node[1], node[2]);
        // Of a cavity OpenVDB knows nothing but inside.
        const bool isAsked = sides_ && voxels < 0.0f;
        if (isAsked && isInCavity(p)) voxels = -voxels;
        const double reach =
            nearest_ < 0 ? kNoLimit : distanceTo(nearest_, p) + kSpare * layout_.spacing;
        nearest_ = rays_.closestTriangle(p, reach);
        const ClosestOnTriangle closest = closestOn(nearest_, p);
        const double distance = (p - closest.point).norm();
        if (isAsked) {
            sidedPoint_ = p;
            sidedDistance_ = distance;
        } else if (voxels < 0.0f && isOutside(p, closest)) {
            isContradicted_.store(true, std::memory_order_relaxed);
        }
        return static_cast<float>(std::copysign(distance, static_cast<double>(voxels)));
    }

private:
    static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

    /// Searches reach this share of a spacing farther than they must: they are made in single
    /// precision, and the surface may pass through the node.
    static constexpr double kSpare = 1e-3;

    ClosestOnTriangle closestOn(int triangle, const Vec3& p) const
    {
        return closestOnTriangle(p, cornersOf(mesh_, triangle));
    }
    double distanceTo(int triangle, const Vec3& p) const
    {
        return (p - closestOn(triangle, p).point).norm();
    }

    /// Whether the face says so that a point is closest to. An edge or a corner does not. Nearer
    /// than a spacing OpenVDB errs now and then, and the mesh itself is asked (signed_distance.h).
    bool isOutside(const Vec3& p, const ClosestOnTriangle& closest) const
    {
        if (closest.feature != TriangleFeature::face) return false;
        const Vec3 normal = cornersOf(mesh_, nearest_).normal();
        return normal.dot(p - closest.point) > layout_.spacing;
    }

    /// Of a point that OpenVDB takes for solid. Within its distance from the surface a point has
    /// its neighbours on its own side: so few are asked for their winding number, which costs a
    /// hundred times a distance (all of an hourglass at 256 nodes: 28 s).
    bool isInCavity(const Vec3& p)
    {
        const bool isKnown = (p - sidedPoint_).norm() < sidedDistance_;
        if (!isKnown) isInCavity_ = sides_->at(p) < 0.5;
        return isInCavity_;
    }

    const TriMesh& mesh_;
    const SurfaceRays& rays_;
    const NodeLayout& layout_;
    openvdb::FloatGrid::ConstAccessor accessor_;
    const WindingNumber* sides_;
    std::atomic<bool>& isContradicted_;
    int nearest_ = -1;                // to the last node
    Vec3 sidedPoint_ = Vec3::Zero();  // the last one that was asked for its side
    double sidedDistance_ = 0.0;
    bool isInCavity_ = false;
};

/// Calls visit(node) for every node of a block, those on its faces included, x fastest.
template <class Visit>
void visitNodes(const NodeLayout& layout, const Index3& block, const Visit& visit)
{
    const Index3 cells = cellsOfBlock(layout, block);
    for (int k = 0; k <= cells[2]; ++k) {
        for (int j = 0; j <= cells[1]; ++j) {
            for (int i = 0; i <= cells[0]; ++i) {
                visit(Index3{kBlockCells * block[0] + i, kBlockCells * block[1] + j,
                             kBlockCells * block[2] + k});
            }
        }
    }
}

Index3 bitsOf(int corner)
{
    return {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
}

/// The corner nodes of a block, x fastest.
std::array<Index3, 8> cornersOf(const NodeLayout& layout, const Index3& block)
{
    const Index3 cells = cellsOfBlock(layout, block);
    std::array<Index3, 8> corners;
    for (int c = 0; c < 8; ++c) {
        for (int axis = 0; axis < 3; ++axis) {
            corners[c][axis] = kBlockCells * block[axis] + bitsOf(c)[axis] * cells[axis];
        }
    }
    return corners;
}

/// Whether the band has a node in the block or on its faces. OpenVDB's leaves are our blocks, but
/// for the faces that a block shares with the next ones.
bool isInBand(const openvdb::FloatGrid& band, const Index3& block)
{
    auto accessor = band.getConstAccessor();
    for (int c = 0; c < 8; ++c) {
        const Index3 side = bitsOf(c);
        const openvdb::Coord origin(kBlockCells * (block[0] + side[0]),
                                    kBlockCells * (block[1] + side[1]),
                                    kBlockCells * (block[2] + side[2]));
        const auto* leaf = accessor.probeConstLeaf(origin);
        if (!leaf) continue;
        for (auto node = leaf->cbeginValueOn(); node; ++node) {
            const openvdb::Coord at = node.getCoord() - origin;
            bool isOurs = true;
            for (int axis = 0; axis < 3; ++axis) isOurs &= side[axis] == 0 || at[axis] == 0;
            if (isOurs) return true;
        }
    }
    return false;
}

void noteRange(FieldBlock& block, float value)
{
    block.low = std::min(block.low, value);
    block.high = std::max(block.high, value);
}

void fillDense(DistanceNodes& nodes, const NodeSource& source)
{
    const auto [nx, ny, nz] = nodes.layout.count;
    nodes.values.resize(nodes.layout.nodeCount());
    parallelFor(nz, 1, [&](std::size_t begin, std::size_t end) {
        NodeReader reader(source, nodes.layout);
        for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k) {
            for (int j = 0; j < ny; ++j) {
                for (int i = 0; i < nx; ++i) {
                    nodes.values[nodes.valueIndex({i, j, k}, {})] = reader.read({i, j, k});
                }
            }
        }
    });
}

/// Where the surface comes nearest to the middle of a block, from there, in spacings.
Vec3 wayToSurface(const NodeSource& source, const NodeLayout& layout, const Index3& block)
{
    const double h = layout.spacing;
    const Vec3 centre =
        layout.node(kBlockCells * block[0], kBlockCells * block[1], kBlockCells * block[2]) +
        Vec3::Constant(0.5 * kBlockCells * h);
    const int t = source.rays.closestTriangle(centre);
    return (closestOnTriangle(centre, cornersOf(source.mesh, t)).point - centre) / h;
}

/// Whether the surface comes as near to a block that OpenVDB has no band in as the band is wide. It
/// has none around the walls of a cavity, where it sees nothing but inside.
bool isForgotten(const NodeSource& source, const NodeLayout& layout, const Index3& block)
{
    constexpr int kHalf = kBlockCells / 2;
    const openvdb::Coord middle(kBlockCells * block[0] + kHalf, kBlockCells * block[1] + kHalf,
                                kBlockCells * block[2] + kHalf);
    if (source.band->tree().getValue(middle) > 0.0f) return false;
    const Vec3 way = wayToSurface(source, layout, block);
    if (source.sides) return way.norm() < kBlockCells * kHalfDiagonal + kBandVoxels;
    if (way.cwiseAbs().maxCoeff() < 0.5 * kBlockCells)
        source.isContradicted.store(true, std::memory_order_relaxed);
    return false;
}

/// Gives every block its place among the values; returns how many there are.
std::size_t layOutBricks(DistanceNodes& nodes, const NodeSource& source)
{
    parallelFor(nodes.blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Index3 block = nodes.blockAt(b);
            const bool isFine =
                isInBand(*source.band, block) || isForgotten(source, nodes.layout, block);
            nodes.blocks[b].isCoarse = isFine ? 0 : 1;
        }
    });
    std::size_t count = 0;
    for (FieldBlock& block : nodes.blocks) {
        block.first = static_cast<std::uint32_t>(count);
        count += block.isCoarse ? 8 : kBrickValues;
    }
    return count;
}

/// What the field says at a node that belongs to a coarse block; nothing where none of the blocks
/// around the node is coarse.
std::optional<float> coarseValue(const DistanceNodes& nodes, const Index3& node)
{
    for (int c = 0; c < 8; ++c) {
        const Index3 side = bitsOf(c);
        Index3 cell;
        bool isThere = true;
        for (int axis = 0; axis < 3; ++axis) {
            cell[axis] = node[axis] - side[axis];
            isThere &= cell[axis] >= 0 && cell[axis] < nodes.layout.count[axis] - 1;
        }
        if (!isThere || !nodes.blockOf(cell).isCoarse) continue;
        const std::size_t block = nodes.blockIndex(cell);
        return static_cast<float>(nodes.interpolateCoarse(block, node));
    }
    return std::nullopt;
}

void fillBricks(DistanceNodes& nodes, const NodeSource& source)
{
    const auto forEachBlock = [&](bool coarse, const auto& fill) {
        parallelFor(nodes.blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
            NodeReader reader(source, nodes.layout);
            for (std::size_t b = begin; b < end; ++b) {
                if ((nodes.blocks[b].isCoarse != 0) == coarse) fill(reader, b);
            }
        });
    };
    forEachBlock(true, [&](NodeReader& reader, std::size_t b) {
        const auto corners = cornersOf(nodes.layout, nodes.blockAt(b));
        for (int c = 0; c < 8; ++c)
            nodes.values[nodes.blocks[b].first + c] = reader.read(corners[c]);
    });
    forEachBlock(false, [&](NodeReader& reader, std::size_t b) {
        const Index3 at = nodes.blockAt(b);
        visitNodes(nodes.layout, at, [&](const Index3& node) {
            const float exact = reader.read(node);
            const float value = coarseValue(nodes, node).value_or(exact);
            nodes.values[nodes.valueIndex(node, at)] = value;
            // Read on below as what the value exceeds the distance by.
            nodes.blocks[b].slack = std::max(nodes.blocks[b].slack, std::abs(value - exact));
        });
    });
}

/// Lowest and highest value of every block, and how far interpolation can be off.  [A11]
void noteRanges(DistanceNodes& nodes)
{
    const double halfCell = kHalfDiagonal * nodes.layout.spacing;
    parallelFor(nodes.blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            FieldBlock& block = nodes.blocks[b];
            block.low = std::numeric_limits<float>::infinity();
            block.high = -std::numeric_limits<float>::infinity();
            if (block.isCoarse) {
                for (int c = 0; c < 8; ++c) noteRange(block, nodes.values[block.first + c]);
                block.slack = static_cast<float>(kBlockCells * halfCell);
                continue;
            }
            const Index3 at = nodes.blockAt(b);
            visitNodes(nodes.layout, at, [&](const Index3& node) {
                noteRange(block, nodes.values[nodes.valueIndex(node, at)]);
            });
            block.slack = std::nextafter(static_cast<float>(halfCell + block.slack), 1e30f);
        }
    });
}

DistanceNodes nodesFrom(const NodeSource& source, const NodeLayout& layout, FieldStorage storage)
{
    const std::size_t denseBytes = layout.nodeCount() * sizeof(float);
    if (storage == FieldStorage::automatic && denseBytes <= kSmallLattice) {
        storage = FieldStorage::dense;
    }
    if (storage != FieldStorage::dense) {
        DistanceNodes nodes = emptyNodes(layout, FieldStorage::bricks);
        const std::size_t count = layOutBricks(nodes, source);
        if (storage == FieldStorage::bricks || 4 * count * sizeof(float) <= 3 * denseBytes) {
            nodes.values.resize(count);
            fillBricks(nodes, source);
            noteRanges(nodes);
            return nodes;
        }
    }
    DistanceNodes nodes = emptyNodes(layout, FieldStorage::dense);
    fillDense(nodes, source);
    noteRanges(nodes);
    return nodes;
}

}  // namespace

DistanceNodes buildDistanceNodes(const TriMesh& mesh, const SurfaceRays& rays,
                                 const NodeLayout& layout, FieldStorage storage)
{
    NodeSource source{mesh, rays, narrowBand(mesh, layout), sidesOf(mesh)};
    DistanceNodes nodes = nodesFrom(source, layout, storage);
    if (!source.isContradicted) return nodes;
    source.sides.emplace(mesh);
    return nodesFrom(source, layout, storage);
}

}  // namespace scree
