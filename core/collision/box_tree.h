// A binary tree of boxes around the boxes of bodies. Nothing in it has a size of its own, so bodies
// of any sizes, anywhere, are found in about the same time.  [A14]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/aabb.h"
#include "core/scene/body.h"

namespace scree {

class BoxTree {
public:
    /// Of some bodies by the boxes of all, which are finite and not empty. Splits at the median of
    /// the axis along which they are farthest apart until few are left.
    void build(std::span<const BodyId> bodies, const std::vector<Aabb>& boxes);

    /// Of the same bodies where they are now. The farther they have gone, each its own way, since
    /// the tree was built, the longer a visit takes.
    void refit(const std::vector<Aabb>& boxes);

    /// Calls leaf(body) for all whose boxes overlap this one, and for some others.
    template <class Leaf>
    void visit(const Aabb& box, const Leaf& leaf) const
    {
        for (std::size_t n = 0; n < nodes_.size();) {
            const Node& node = nodes_[n];
            if (!node.box.overlaps(box)) {
                n = node.next;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) leaf(entries_[i].body);
            ++n;
        }
    }

private:
    struct Node {
        Aabb box;
        std::uint32_t begin = 0, end = 0;  // entries of a leaf; empty for an inner node
        std::uint32_t next = 0;  // the node after this whole subtree, in depth-first order
    };
    struct Entry {
        Vec3 centre;  // when the tree was built
        BodyId body;
    };

    void build(std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;  // depth-first
    std::vector<Entry> entries_;
};

}  // namespace scree
