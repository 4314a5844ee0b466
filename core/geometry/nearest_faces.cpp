// Symbols: h node spacing, phi signed distance.
#include "core/geometry/nearest_faces.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

struct Face {
    TriangleCorners corners;
    Vec3 normal;
};

/// A triangle that passes near the centre of a cell.
struct Near {
    std::uint32_t face;
    double distance;
};

using BlockCell = std::array<int, 3>;

float roundedDown(double distance)
{
    return static_cast<float>((1.0 - 1e-6) * distance);
}

/// The cells of one block in which the surface is near.
class BlockLists {
public:
    BlockLists(const DistanceNodes& nodes, const BlockCell& block)
        : layout_(nodes.layout), block_(block), cells_(cellsOfBlock(nodes.layout, block))
    {
        const double band = refinementBandOf(layout_.spacing);
        for (int k = 0; k < cells_[2]; ++k) {
            for (int j = 0; j < cells_[1]; ++j) {
                for (int i = 0; i < cells_[0]; ++i) measureCell(nodes, {i, j, k}, band);
            }
        }
    }

    bool isEmpty() const { return !hasAny_; }

    /// Lists the triangle in the cells it passes near. A triangle can be closest somewhere in a
    /// cell only if, seen from the cell's centre, it is at most a cell diagonal farther than the
    /// closest one, and that one is at most half a diagonal farther than the nearest node says.
    void add(std::uint32_t index, const Face& face, double reach)
    {
        const TriangleCorners& corners = face.corners;
        const double h = layout_.spacing;
        const Vec3 low = corners.a.cwiseMin(corners.b).cwiseMin(corners.c);
        const Vec3 high = corners.a.cwiseMax(corners.b).cwiseMax(corners.c);
        BlockCell first, last;
        for (int axis = 0; axis < 3; ++axis) {
            const double origin = layout_.origin[axis] + h * kBlockCells * block_[axis];
            first[axis] =
                std::max(0, static_cast<int>(std::floor((low[axis] - reach - origin) / h)));
            last[axis] = std::min(
                cells_[axis], static_cast<int>(std::floor((high[axis] + reach - origin) / h)) + 1);
        }
        for (int k = first[2]; k < last[2]; ++k) {
            for (int j = first[1]; j < last[1]; ++j) {
                for (int i = first[0]; i < last[0]; ++i) {
                    const int cell = NearestFaces::indexInBlock({i, j, k});
                    if (nearest_[cell] < 0.0) continue;
                    const double limit = nearest_[cell] + 3.0 * kHalfDiagonal * h;
                    const Vec3 centre =
                        layout_.node(kBlockCells * block_[0] + i, kBlockCells * block_[1] + j,
                                     kBlockCells * block_[2] + k) +
                        Vec3::Constant(0.5 * h);
                    if (std::abs(face.normal.dot(centre - corners.a)) > limit) continue;
                    const Vec3 closest = closestOnTriangle(centre, corners).point;
                    const double distance = (centre - closest).norm();
                    if (distance <= limit) near_[cell].push_back({index, distance});
                }
            }
        }
    }

    /// Appends the lists to the others, cut to a cell diagonal beyond the closest.
    void appendTo(NearestFaces& lists)
    {
        const double diagonal = 2.0 * kHalfDiagonal * layout_.spacing * (1.0 + 1e-9);
        for (std::vector<Near>& near : near_) {
            lists.start.push_back(static_cast<std::uint32_t>(lists.faces.size()));
            std::ranges::stable_sort(near, {}, &Near::distance);
            for (const Near& entry : near) {
                if (entry.distance > near.front().distance + diagonal) break;
                lists.faces.push_back({entry.face, roundedDown(entry.distance)});
            }
        }
        lists.start.push_back(static_cast<std::uint32_t>(lists.faces.size()));
    }

private:
    void measureCell(const DistanceNodes& nodes, const BlockCell& inBlock, double band)
    {
        BlockCell node;
        for (int axis = 0; axis < 3; ++axis)
            node[axis] = kBlockCells * block_[axis] + inBlock[axis];
        double lowest = 1e300, highest = -1e300, nearest = 1e300;
        for (int corner = 0; corner < 8; ++corner) {
            const double phi = nodes.nodeValue(
                {node[0] + (corner & 1), node[1] + (corner >> 1 & 1), node[2] + (corner >> 2)},
                block_);
            lowest = std::min(lowest, phi);
            highest = std::max(highest, phi);
            nearest = std::min(nearest, std::abs(phi));
        }
        if (lowest > band || highest < -band) return;
        nearest_[NearestFaces::indexInBlock(inBlock)] = nearest;
        hasAny_ = true;
    }

    const NodeLayout& layout_;
    BlockCell block_, cells_;
    bool hasAny_ = false;
    std::vector<double> nearest_ = std::vector<double>(kBlockCells * kBlockCells * kBlockCells,
                                                       -1.0);  // of a cell's nodes; −1: far [m]
    std::vector<std::vector<Near>> near_ =
        std::vector<std::vector<Near>>(kBlockCells * kBlockCells * kBlockCells);
};

/// For every block the triangles within `reach`, ascending.
std::vector<std::vector<std::uint32_t>> facesByBlock(const DistanceNodes& nodes,
                                                     const std::vector<Face>& all, double reach)
{
    std::vector<std::vector<std::uint32_t>> faces(nodes.blocks.size());
    const double width = kBlockCells * nodes.layout.spacing;
    for (std::uint32_t f = 0; f < all.size(); ++f) {
        const TriangleCorners& face = all[f].corners;
        const Vec3 low = face.a.cwiseMin(face.b).cwiseMin(face.c) - nodes.layout.origin;
        const Vec3 high = face.a.cwiseMax(face.b).cwiseMax(face.c) - nodes.layout.origin;
        BlockCell first, last;
        for (int axis = 0; axis < 3; ++axis) {
            const int limit = nodes.blockCount[axis] - 1;
            first[axis] = std::clamp(static_cast<int>((low[axis] - reach) / width), 0, limit);
            last[axis] = std::clamp(static_cast<int>((high[axis] + reach) / width), 0, limit);
        }
        for (int k = first[2]; k <= last[2]; ++k) {
            for (int j = first[1]; j <= last[1]; ++j) {
                for (int i = first[0]; i <= last[0]; ++i) {
                    faces[i + static_cast<std::size_t>(nodes.blockCount[0]) *
                                  (j + static_cast<std::size_t>(nodes.blockCount[1]) * k)]
                        .push_back(f);
                }
            }
        }
    }
    return faces;
}

}  // namespace

NearestFaces findNearestFaces(const TriMesh& mesh, DistanceNodes& nodes)
{
    std::vector<Face> all;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f)
        all.push_back({cornersOf(mesh, f), cornersOf(mesh, f).normal()});
    const double band = refinementBandOf(nodes.layout.spacing);
    const double reach = band + 3.0 * kHalfDiagonal * nodes.layout.spacing;
    const std::vector<std::vector<std::uint32_t>> faces = facesByBlock(nodes, all, reach);

    // Each block by itself, then all behind one another in the blocks' own order.
    std::vector<NearestFaces> ofBlock(nodes.blocks.size());
    parallelFor(nodes.blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const FieldBlock& block = nodes.blocks[b];
            if (block.isCoarse || block.low > band || block.high < -band) continue;
            BlockLists lists(nodes, nodes.blockAt(b));
            if (lists.isEmpty()) continue;
            for (const std::uint32_t f : faces[b]) lists.add(f, all[f], reach);
            lists.appendTo(ofBlock[b]);
        }
    });

    NearestFaces together;
    for (std::size_t b = 0; b < nodes.blocks.size(); ++b) {
        const NearestFaces& own = ofBlock[b];
        if (own.start.empty()) continue;
        nodes.blocks[b].candidates = static_cast<std::uint32_t>(together.start.size());
        for (const std::uint32_t start : own.start) {
            together.start.push_back(start + static_cast<std::uint32_t>(together.faces.size()));
        }
        together.faces.insert(together.faces.end(), own.faces.begin(), own.faces.end());
    }
    return together;
}

}  // namespace scree
