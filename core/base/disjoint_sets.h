// Sets that grow by joining.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace scree {

/// Of 0 … count − 1, each alone at first; the lowest member stands for its set.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count = 0) { begin(count); }

    /// Forgets all and begins anew, in the same memory.
    void begin(std::size_t count)
    {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t find(std::size_t x)
    {
        while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
        return x;
    }
    void join(std::size_t a, std::size_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

}  // namespace scree
