// Symbols: p a point in the frame of the field, i j k the cell it is in.
#include "core/geometry/distance_lanes.h"

#include <cstddef>

namespace scree {
namespace {

/// Some ten operations, each of which loses 2⁻²⁴ of numbers as large as what they measure.
constexpr double kRounding = 2e-6;

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
    return reinterpret_cast<IntLanes>(_mm256_i32gather_epi32(
        reinterpret_cast<const int*>(values), reinterpret_cast<__m256i>(index), 4));
}

struct AxisLanes {
    IntLanes cell;
    FloatLanes fraction;
};

AxisLanes placeAlong(FloatLanes x, int count)
{
    IntLanes cell = __builtin_convertvector(x, IntLanes);
    cell = minOf(maxOf(cell, intLanesOf(0)), intLanesOf(count - 2));
    return {cell, x - __builtin_convertvector(cell, FloatLanes)};
}

}  // namespace

DistanceLanes::DistanceLanes(const SignedDistance& field, const Mat3& rotation,
                             const Vec3& translation, double extent)
    : field_(field),
      rows_{FloatLanes3::all(rotation.row(0)), FloatLanes3::all(rotation.row(1)),
            FloatLanes3::all(rotation.row(2))},
      translation_(FloatLanes3::all(translation)),
      rounding_(floatLanesOf(kRounding * (translation.norm() + extent)))
{
    if (field.solid()) return;
    boxMin_ = FloatLanes3::all(field.surfaceBox().min);
    boxMax_ = FloatLanes3::all(field.surfaceBox().max);
    domainMin_ = FloatLanes3::all(field.domain().min);
    domainMax_ = FloatLanes3::all(field.domain().max);
    inverseSpacing_ = floatLanesOf(1.0 / field.spacing());
}

FloatLanes3 DistanceLanes::placed(const FloatLanes3& p) const
{
    return {dot(rows_[0], p) + translation_.x, dot(rows_[1], p) + translation_.y,
            dot(rows_[2], p) + translation_.z};
}

FloatLanes DistanceLanes::ofFormula(const FloatLanes3& p) const
{
    FloatLanes value;
    for (int lane = 0; lane < kFloatLanes; ++lane)
        value[lane] = static_cast<float>(field_.solid()->value(p.get(lane)));
    return value;
}

FloatLanes DistanceLanes::ofNodes(const FloatLanes3& p) const
{
    const DistanceNodes& nodes = field_.field().nodes;
    const auto& count = nodes.layout.count;
    const AxisLanes x = placeAlong((p.x - domainMin_.x) * inverseSpacing_, count[0]);
    const AxisLanes y = placeAlong((p.y - domainMin_.y) * inverseSpacing_, count[1]);
    const AxisLanes z = placeAlong((p.z - domainMin_.z) * inverseSpacing_, count[2]);
    static_assert(kBlockCells == 8);
    const IntLanes blockX = x.cell >> 3, blockY = y.cell >> 3, blockZ = z.cell >> 3;
    const IntLanes block =
        kStride * (blockX + nodes.blockCount[0] * (blockY + nodes.blockCount[1] * blockZ));
    FloatLanes fx = x.fraction, fy = y.fraction, fz = z.fraction;
    IntLanes dx = intLanesOf(1), dy, dz, corner;
    if (nodes.storage == FieldStorage::dense) {
        dy = intLanesOf(count[0]);
        dz = intLanesOf(count[0] * count[1]);
        corner = x.cell + dy * y.cell + dz * z.cell;
    } else {
        const IntLanes isCoarse =
            gatheredInts(first(nodes, &FieldBlock::isCoarse), block) != intLanesOf(0);
        dy = isCoarse ? intLanesOf(2) : intLanesOf(kBrickNodes);
        dz = isCoarse ? intLanesOf(4) : intLanesOf(kBrickNodes * kBrickNodes);
        const auto inBlock = [&](const AxisLanes& axis, IntLanes at, int nodesAlong,
                                 FloatLanes& fraction) {
            const IntLanes cell = axis.cell - 8 * at;
            const IntLanes cells = minOf(intLanesOf(kBlockCells), nodesAlong - 1 - 8 * at);
            const FloatLanes ofCoarse = (__builtin_convertvector(cell, FloatLanes) + fraction) /
                                        __builtin_convertvector(cells, FloatLanes);
            fraction = isCoarse ? ofCoarse : fraction;
            return isCoarse ? intLanesOf(0) : cell;
        };
        corner = gatheredInts(first(nodes, &FieldBlock::first), block) +
                 inBlock(x, blockX, count[0], fx) + dy * inBlock(y, blockY, count[1], fy) +
                 dz * inBlock(z, blockZ, count[2], fz);
    }
    const float* values = nodes.values.data();
    const auto alongX = [&](IntLanes at) {
        const FloatLanes a = gathered(values, at), b = gathered(values, at + dx);
        return a + fx * (b - a);
    };
    const FloatLanes y0 = alongX(corner), y1 = alongX(corner + dy);
    const FloatLanes z0 = y0 + fy * (y1 - y0);
    const FloatLanes y2 = alongX(corner + dz), y3 = alongX(corner + dz + dy);
    const FloatLanes z1 = y2 + fy * (y3 - y2);
    return z0 + fz * (z1 - z0) - gathered(first(nodes, &FieldBlock::slack), block);
}

FloatLanes DistanceLanes::apartAtLeast(const SphereLanes& spheres) const
{
    const FloatLanes3 p = placed(spheres.centre);
    if (field_.solid()) return ofFormula(p) - spheres.radius - rounding_;
    // Nothing in a convex box is nearer to a point than to the point of the box next to it.
    const auto clamped = [&p](const FloatLanes3& low, const FloatLanes3& high) {
        return FloatLanes3{minOf(maxOf(p.x, low.x), high.x), minOf(maxOf(p.y, low.y), high.y),
                           minOf(maxOf(p.z, low.z), high.z)};
    };
    const FloatLanes3 toBox = p - clamped(boxMin_, boxMax_);
    const FloatLanes apart =
        maxOf(sqrtOf(dot(toBox, toBox)), ofNodes(clamped(domainMin_, domainMax_)));
    return apart - spheres.radius - rounding_;
}

}  // namespace scree
