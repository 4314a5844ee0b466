// A binary tree of bounding spheres over things that have bounding spheres (points, edges).  [A13]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/ball.h"

namespace scree {

class SphereTree {
public:
    SphereTree() = default;
    /// Splits at the median of the longest axis until at most 8 things are left; the same input
    /// gives the same tree everywhere.
    explicit SphereTree(std::span<const Ball> things);

    /// Calls leaf(thing) for every thing below nodes that prune(centre, radius) does not reject.
    template <class Prune, class Leaf>
    void visit(const Prune& prune, const Leaf& leaf) const
    {
        for (std::size_t n = 0; n < nodes_.size();) {
            const Node& node = nodes_[n];
            if (prune(node.sphere.centre, node.sphere.radius)) {
                n = node.next;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) leaf(things_[i]);
            ++n;
        }
    }

    /// A few spheres that together hold everything.
    std::span<const Ball> cover() const { return cover_; }

private:
    struct Node {
        Ball sphere;
        std::uint32_t begin = 0, end = 0;  // things of a leaf; empty for an inner node
        std::uint32_t next = 0;  // the node after this whole subtree, in depth-first order
    };

    void build(std::span<const Ball> things, std::uint32_t begin, std::uint32_t end, int depth);

    std::vector<Node> nodes_;  // depth-first
    std::vector<std::uint32_t> things_;
    std::vector<Ball> cover_;
};

}  // namespace scree
