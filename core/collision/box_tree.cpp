#include "core/collision/box_tree.h"

#include <algorithm>
#include <ranges>

namespace scree {
namespace {

constexpr std::uint32_t kBodiesOfLeaf = 4;

}  // namespace

void BoxTree::build(std::span<const BodyId> bodies, const std::vector<Aabb>& boxes)
{
    nodes_.clear();
    entries_.clear();
    if (bodies.empty()) return;
    for (const BodyId body : bodies) entries_.push_back({boxes[body].centre(), body});
    build(0, static_cast<std::uint32_t>(entries_.size()));
    refit(boxes);
}

void BoxTree::build(std::uint32_t begin, std::uint32_t end)
{
    const std::size_t n = nodes_.size();
    nodes_.emplace_back();
    if (end - begin <= kBodiesOfLeaf) {
        nodes_[n].begin = begin;
        nodes_[n].end = end;
    } else {
        Aabb around;
        for (std::uint32_t i = begin; i < end; ++i) around.include(entries_[i].centre);
        int axis = 0;
        around.size().maxCoeff(&axis);
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(
            entries_.begin() + begin, entries_.begin() + middle, entries_.begin() + end,
            [axis](const Entry& p, const Entry& q) { return p.centre[axis] < q.centre[axis]; });
        build(begin, middle);
        build(middle, end);
    }
    nodes_[n].next = static_cast<std::uint32_t>(nodes_.size());
}

void BoxTree::refit(const std::vector<Aabb>& boxes)
{
    // What is below a node comes after it.
    for (Node& node : nodes_ | std::views::reverse) {
        node.box = {};
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            node.box.include(boxes[entries_[i].body]);
        if (node.begin < node.end) continue;
        const Node& first = *(&node + 1);
        const Node& second = nodes_[first.next];
        node.box.include(first.box);
        node.box.include(second.box);
    }
}

}  // namespace scree
