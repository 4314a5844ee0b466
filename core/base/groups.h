// Items that belong to numbered groups, group by group in one array.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace scree {

/// A list of lists would allocate for each of them; this keeps its memory from one use to the next.
class Groups {
public:
    /// Sorts items by groupOf(item), 0 … groupCount − 1; those of which it answers groupCount are
    /// left out. Within a group they keep their order.
    template <class GroupOf>
    void sort(std::span<const std::size_t> items, std::size_t groupCount, const GroupOf& groupOf)
    {
        // While items are placed, the begin of a group stands one place higher and moves on.
        begin_.assign(groupCount + 3, 0);
        for (const std::size_t item : items) ++begin_[groupOf(item) + 2];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        items_.resize(items.size());
        for (const std::size_t item : items) items_[begin_[groupOf(item) + 1]++] = item;
        size_ = groupCount;
    }

    std::size_t size() const { return size_; }
    std::span<const std::size_t> operator[](std::size_t group) const
    {
        return std::span(items_).subspan(begin_[group], begin_[group + 1] - begin_[group]);
    }

private:
    std::size_t size_ = 0;
    std::vector<std::size_t> begin_, items_;
};

}  // namespace scree
