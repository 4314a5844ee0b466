#include "core/geometry/sphere_lanes.h"

#include <algorithm>
#include <numeric>

#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kRoundUp = 1e-6;  // of what single precision loses of a sphere

/// Halves [begin, end) across its longest side, and both halves again, so that eights of things,
/// and eights of eights, are near each other: cut anywhere else they would straddle what is apart.
void sortIntoEights(std::span<const Ball> spheres, std::uint32_t* begin, std::uint32_t* end)
{
    const std::ptrdiff_t count = end - begin;
    if (count <= kFloatLanes) return;
    std::ptrdiff_t whole = kFloatLanes;
    while (whole * kFloatLanes < count) whole *= kFloatLanes;
    const std::ptrdiff_t groups = (count + whole - 1) / whole;
    std::uint32_t* const middle = begin + (groups + 1) / 2 * whole;
    Aabb centres;
    for (const std::uint32_t* i = begin; i < end; ++i) centres.include(spheres[*i].centre);
    Eigen::Index axis = 0;
    centres.size().maxCoeff(&axis);
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
        const double ca = spheres[a].centre[axis], cb = spheres[b].centre[axis];
        return ca < cb || (ca == cb && a < b);
    });
    sortIntoEights(spheres, begin, middle);
    sortIntoEights(spheres, middle, end);
}

/// One sphere around each eight.
std::vector<Ball> heldByEights(std::span<const Ball> spheres)
{
    std::vector<Ball> holding;
    for (std::size_t begin = 0; begin < spheres.size(); begin += kFloatLanes) {
        const auto eight =
            spheres.subspan(begin, std::min<std::size_t>(kFloatLanes, spheres.size() - begin));
        Aabb centres;
        for (const Ball& sphere : eight) centres.include(sphere.centre);
        Ball& held = holding.emplace_back(Ball{centres.centre(), 0.0});
        for (const Ball& sphere : eight) {
            held.radius =
                std::max(held.radius, (sphere.centre - held.centre).norm() + sphere.radius);
        }
    }
    return holding;
}

}  // namespace

std::vector<SphereLanes> inLanes(std::span<const Ball> spheres)
{
    std::vector<SphereLanes> lanes((spheres.size() + kFloatLanes - 1) / kFloatLanes);
    for (std::size_t i = 0; i < kFloatLanes * lanes.size(); ++i) {
        SphereLanes& eight = lanes[i / kFloatLanes];
        const int lane = static_cast<int>(i % kFloatLanes);
        const Ball& sphere = spheres[std::min(i, spheres.size() - 1)];
        eight.centre.set(lane, sphere.centre);
        eight.radius[lane] =
            static_cast<float>(sphere.radius + kRoundUp * (sphere.radius + sphere.centre.norm()));
    }
    return lanes;
}

SphereLaneTree::SphereLaneTree(std::span<const Ball> things)
{
    cover_ = inLanes(SphereTree(things).cover());
    things_.resize(things.size());
    std::iota(things_.begin(), things_.end(), 0u);
    sortIntoEights(things, things_.data(), things_.data() + things_.size());
    std::vector<Ball> level;
    for (const std::uint32_t thing : things_) level.push_back(things[thing]);
    while (!level.empty()) {
        levels_.push_back(inLanes(level));
        if (levels_.back().size() == 1) break;
        level = heldByEights(level);
    }
}

}  // namespace scree
