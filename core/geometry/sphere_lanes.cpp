#include "core/geometry/sphere_lanes.h"

#include <algorithm>

#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kRoundUp = 1e-6;  // of what single precision loses of a sphere

/// One sphere around each eight.
std::vector<Sphere> heldByEights(std::span<const Sphere> spheres)
{
    std::vector<Sphere> holding;
    for (std::size_t begin = 0; begin < spheres.size(); begin += kFloatLanes) {
        const auto eight =
            spheres.subspan(begin, std::min<std::size_t>(kFloatLanes, spheres.size() - begin));
        Aabb centres;
        for (const Sphere& sphere : eight) centres.include(sphere.centre);
        Sphere& held = holding.emplace_back(Sphere{centres.centre(), 0.0});
        for (const Sphere& sphere : eight) {
            held.radius =
                std::max(held.radius, (sphere.centre - held.centre).norm() + sphere.radius);
        }
    }
    return holding;
}

}  // namespace

std::vector<SphereLanes> inLanes(std::span<const Sphere> spheres)
{
    std::vector<SphereLanes> lanes((spheres.size() + kFloatLanes - 1) / kFloatLanes);
    for (std::size_t i = 0; i < kFloatLanes * lanes.size(); ++i) {
        SphereLanes& eight = lanes[i / kFloatLanes];
        const int lane = static_cast<int>(i % kFloatLanes);
        const Sphere& sphere = spheres[std::min(i, spheres.size() - 1)];
        eight.centre.set(lane, sphere.centre);
        eight.radius[lane] =
            static_cast<float>(sphere.radius + kRoundUp * (sphere.radius + sphere.centre.norm()));
    }
    return lanes;
}

SphereLaneTree::SphereLaneTree(std::span<const Sphere> things)
{
    const SphereTree tree(things);
    things_.assign(tree.things().begin(), tree.things().end());
    cover_ = inLanes(tree.cover());
    std::vector<Sphere> level;
    for (const std::uint32_t thing : things_) level.push_back(things[thing]);
    while (!level.empty()) {
        levels_.push_back(inLanes(level));
        if (levels_.back().size() == 1) break;
        level = heldByEights(level);
    }
}

}  // namespace scree
