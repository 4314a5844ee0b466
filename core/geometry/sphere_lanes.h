// Bounding spheres eight abreast, and a tree of them over things that have bounding spheres: a step
// down asks eight children at once.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/sphere_tree.h"
#include "core/math/lanes.h"

namespace scree {

/// Rounded up, so that they hold what they hold. Lanes that are left over repeat the last sphere.
struct SphereLanes {
    FloatLanes3 centre;
    FloatLanes radius;  ///< [m]
};

/// As many as it takes for all of them.
std::vector<SphereLanes> inLanes(std::span<const Ball> spheres);

class SphereLaneTree {
public:
    SphereLaneTree() = default;
    /// The same input gives the same tree everywhere.
    explicit SphereLaneTree(std::span<const Ball> things);

    /// near(spheres) tells by its bits which of eight matter; leaf(thing, lane) hears of all things
    /// that do, those near each other one after the other, right after near() heard of their
    /// spheres.
    template <class Near, class Leaf>
    void visit(const Near& near, const Leaf& leaf) const
    {
        if (!levels_.empty()) visit(near, leaf, levels_.size() - 1, 0);
    }

    /// A few spheres that together hold everything.
    const std::vector<SphereLanes>& cover() const { return cover_; }

private:
    template <class Near, class Leaf>
    void visit(const Near& near, const Leaf& leaf, std::size_t level, std::size_t group) const
    {
        const std::size_t count = level > 0 ? levels_[level - 1].size() : things_.size();
        for (unsigned bits = near(levels_[level][group]); bits; bits &= bits - 1) {
            const int lane = std::countr_zero(bits);
            const std::size_t below = kFloatLanes * group + static_cast<std::size_t>(lane);
            if (below >= count) break;
            if (level > 0) {
                visit(near, leaf, level - 1, below);
            } else {
                leaf(things_[below], lane);
            }
        }
    }

    std::vector<std::uint32_t> things_;
    /// [0]: the things; of the next, each sphere holds eight of these; the last is one group.
    std::vector<std::vector<SphereLanes>> levels_;
    std::vector<SphereLanes> cover_;
};

}  // namespace scree
