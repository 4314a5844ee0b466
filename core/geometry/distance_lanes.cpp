// Symbols: p a point in the frame of the field, i j k the node nearest to it.
#include "core/geometry/distance_lanes.h"

#include <cstddef>

namespace scree {
namespace {

IntLanes intLanesOf(int value)
{
    return IntLanes{value, value, value, value, value, value, value, value};
}

/// Members of blocks, all of them four bytes.
template <class Member>
const Member* first(const DistanceNodes& nodes, Member FieldBlock::*member)
{
    return &(nodes.blocks.front().*member);
}
constexpr int kStride = sizeof(FieldBlock) / 4;
static_assert(sizeof(FieldBlock) % 4 == 0);

IntLanes gatheredInts(const std::uint32_t* values, IntLanes index)
{
    return reinterpret_cast<IntLanes>(_mm256_i32gather_epi32(reinterpret_cast<const int*>(values),
                                                             reinterpret_cast<__m256i>(index), 4));
}

/// x ≥ 0, rounded.
IntLanes nearestInt(FloatLanes x)
{
    return __builtin_convertvector(x + 0.5f, IntLanes);
}

FloatLanes floatsOf(IntLanes x)
{
    return __builtin_convertvector(x, FloatLanes);
}

}  // namespace

DistanceLanes::DistanceLanes(const SignedDistance& field, const Mat3& rotation,
                             const Vec3& translation, double extent)
    : field_(field),
      rotation_(rotation),
      translation_(FloatLanes3::all(translation)),
      rounding_(floatLanesOf(kSinglePrecision * (translation.norm() + extent)))
{
    if (field.solid()) return;
    boxMin_ = FloatLanes3::all(field.surfaceBox().min);
    boxMax_ = FloatLanes3::all(field.surfaceBox().max);
    domainMin_ = FloatLanes3::all(field.domain().min);
    domainMax_ = FloatLanes3::all(field.domain().max);
    spacing_ = floatLanesOf(field.spacing());
    inverseSpacing_ = floatLanesOf(1.0 / field.spacing());
}

FloatLanes DistanceLanes::ofFormula(const FloatLanes3& p) const
{
    FloatLanes value;
    for (int lane = 0; lane < kFloatLanes; ++lane)
        value[lane] = static_cast<float>(field_.solid()->value(p.get(lane)));
    return value;
}

/// Nodes are exact and nothing is nearer to a point than the nearest node says less the way to it.
FloatLanes DistanceLanes::ofNodes(const FloatLanes3& p) const
{
    const DistanceNodes& nodes = field_.field().nodes;
    const FloatLanes3 at = inverseSpacing_ * (p - domainMin_);
    const auto distanceAt = [&](IntLanes index, const FloatLanes3& node) {
        const FloatLanes3 way = at - node;
        return gathered(nodes.values.data(), index) - spacing_ * sqrtOf(dot(way, way));
    };
    const auto& count = nodes.layout.count;
    if (nodes.storage == FieldStorage::dense) {
        const IntLanes i = nearestInt(at.x), j = nearestInt(at.y), k = nearestInt(at.z);
        return distanceAt(i + count[0] * (j + count[1] * k),
                          {floatsOf(i), floatsOf(j), floatsOf(k)});
    }

    static_assert(kBlockCells == 8);
    const auto blockAlong = [](FloatLanes x, int nodesAlong) {
        const IntLanes cell = __builtin_convertvector(x, IntLanes);
        return minOf(cell, intLanesOf(nodesAlong - 2)) >> 3;
    };
    const IntLanes bx = blockAlong(at.x, count[0]), by = blockAlong(at.y, count[1]),
                   bz = blockAlong(at.z, count[2]);
    const IntLanes block = kStride * (bx + nodes.blockCount[0] * (by + nodes.blockCount[1] * bz));
    const IntLanes isCoarse =
        gatheredInts(first(nodes, &FieldBlock::isCoarse), block) != intLanesOf(0);
    // Of a coarse block only the corners are kept: nodes 0 and 1 along each axis.
    const auto nodeAlong = [&](FloatLanes x, IntLanes blockBegin, int nodesAlong, IntLanes& node) {
        const IntLanes cells = minOf(intLanesOf(kBlockCells), nodesAlong - 1 - blockBegin);
        const FloatLanes inBlock = x - floatsOf(blockBegin);
        const IntLanes isFar = inBlock + inBlock > floatsOf(cells);
        const IntLanes fine = nearestInt(inBlock);
        node = isCoarse ? -isFar : fine;
        return floatsOf(blockBegin + (isCoarse ? isFar & cells : fine));
    };
    IntLanes i, j, k;
    const FloatLanes3 node = {nodeAlong(at.x, 8 * bx, count[0], i),
                              nodeAlong(at.y, 8 * by, count[1], j),
                              nodeAlong(at.z, 8 * bz, count[2], k)};
    const IntLanes perRow = isCoarse ? intLanesOf(2) : intLanesOf(kBrickNodes);
    const IntLanes index =
        gatheredInts(first(nodes, &FieldBlock::first), block) + i + perRow * (j + perRow * k);
    // Where a fine block shares nodes with a coarse one they are interpolated.
    const FloatLanes tooMuch = gathered(first(nodes, &FieldBlock::slack), block) -
                               static_cast<float>(kHalfDiagonal) * spacing_;
    return distanceAt(index, node) - (isCoarse ? FloatLanes{} : tooMuch);
}

FloatLanes DistanceLanes::apartAtLeast(const SphereLanes& spheres) const
{
    const FloatLanes3 p = rotation_ * spheres.centre + translation_;
    if (field_.solid()) return ofFormula(p) - spheres.radius - rounding_;
    // Nothing in a convex box is nearer to a point than to the point of the box next to it.
    const auto clamped = [&p](const FloatLanes3& low, const FloatLanes3& high) {
        return FloatLanes3{minOf(maxOf(p.x, low.x), high.x), minOf(maxOf(p.y, low.y), high.y),
                           minOf(maxOf(p.z, low.z), high.z)};
    };
    const FloatLanes3 toBox = p - clamped(boxMin_, boxMax_);
    const FloatLanes beside = sqrtOf(dot(toBox, toBox));
    const FloatLanes byNodes = ofNodes(clamped(domainMin_, domainMax_));
    const FloatLanes apart = beside > 0.0f ? maxOf(beside, byNodes) : byNodes;
    return apart - spheres.radius - rounding_;
}

}  // namespace scree
