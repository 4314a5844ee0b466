#include "core/geometry/sphere_tree.h"

#include <algorithm>
#include <numeric>

#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr std::uint32_t kLeafSize = 8;
constexpr int kCoverDepth = 4;  // at most 16 spheres

}  // namespace

SphereTree::SphereTree(std::span<const Ball> things) : things_(things.size())
{
    std::iota(things_.begin(), things_.end(), 0u);
    if (!things.empty()) build(things, 0, static_cast<std::uint32_t>(things.size()), 0);
}

void SphereTree::build(std::span<const Ball> things, std::uint32_t begin, std::uint32_t end,
                       int depth)
{
    Aabb centres;
    for (std::uint32_t i = begin; i < end; ++i) centres.include(things[things_[i]].centre);
    Node node;
    node.sphere.centre = centres.centre();
    for (std::uint32_t i = begin; i < end; ++i) {
        const Ball& thing = things[things_[i]];
        node.sphere.radius =
            std::max(node.sphere.radius, (thing.centre - node.sphere.centre).norm() + thing.radius);
    }
    const std::size_t self = nodes_.size();
    nodes_.push_back(node);
    const bool isLeaf = end - begin <= kLeafSize;
    if (depth == kCoverDepth || (depth < kCoverDepth && isLeaf)) cover_.push_back(node.sphere);
    if (isLeaf) {
        nodes_[self].begin = begin;
        nodes_[self].end = end;
    } else {
        Eigen::Index axis = 0;
        centres.size().maxCoeff(&axis);
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(things_.begin() + begin, things_.begin() + middle, things_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double ca = things[a].centre[axis], cb = things[b].centre[axis];
                             return ca < cb || (ca == cb && a < b);
                         });
        build(things, begin, middle, depth + 1);
        build(things, middle, end, depth + 1);
    }
    nodes_[self].next = static_cast<std::uint32_t>(nodes_.size());
}

}  // namespace scree
