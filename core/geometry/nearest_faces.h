// For every cell near the surface, the triangles that can be closest somewhere in it.  [A4]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/distance_nodes.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// A triangle that can be the closest somewhere in a cell.
struct ListedFace {
    std::uint32_t face;
    float fromCentre;  ///< of the cell, rounded down [m]

    bool operator==(const ListedFace&) const = default;
};

/// Lists exist only for the cells of blocks that hold some of the surface: a block's cells have
/// consecutive lists, found by FieldBlock::candidates.
struct NearestFaces {
    std::vector<std::uint32_t> start;  // 8³ + 1 for each block with lists: where each cell's begin
    std::vector<ListedFace> faces;     // of a cell: those nearest to its centre first

    std::span<const ListedFace> of(const DistanceNodes& nodes, const std::array<int, 3>& cell) const
    {
        const std::uint32_t first = nodes.blockOf(cell).candidates;
        if (first == FieldBlock::kNone) return {};
        const std::size_t i = first + static_cast<std::size_t>(indexInBlock(cell));
        return std::span(faces).subspan(start[i], start[i + 1] - start[i]);
    }

    static int indexInBlock(const std::array<int, 3>& cell)
    {
        return cell[0] % kBlockCells +
               kBlockCells * (cell[1] % kBlockCells + kBlockCells * (cell[2] % kBlockCells));
    }
};

/// Lists for every cell in which |interpolated value| can be below the refinement band, and notes
/// in the blocks where they are. The result does not depend on the number of threads.
NearestFaces findNearestFaces(const TriMesh& mesh, DistanceNodes& nodes);

}  // namespace scree
