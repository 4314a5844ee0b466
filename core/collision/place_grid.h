// Places in the cells of a grid, so that those near to one are found without looking at all.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// Places by number, from 0 on. Cells are told apart by a hash: those that share one are looked at
/// together, which changes nothing but time.
class PlaceGrid {
public:
    /// To look for what is within this of a place [m], above 0.
    explicit PlaceGrid(double within)
        : within_(within * (1.0 + kRounding)), perCell_(1.0 / (kWithinsPerCell * within))
    {
    }

    std::size_t size() const { return places_.size(); }

    /// The next one.
    void add(const Vec3& place);

    void move(std::size_t i, const Vec3& place);

    /// Calls visit(i) for all that lie within, and some beside these, in any order; for some of
    /// them more than once.
    template <class Visit>
    void visitNear(const Vec3& place, const Visit& visit) const
    {
        if (first_.empty()) return;
        const Cell low = cellOf(place - Vec3::Constant(within_));
        const Cell high = cellOf(place + Vec3::Constant(within_));
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    for (std::uint32_t i = first_[slotOf({x, y, z})]; i != kNone; i = next_[i])
                        visit(std::size_t{i});
                }
            }
        }
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    static constexpr std::uint32_t kNone = ~0u;
    static constexpr double kRounding = 1e-9;
    /// Along an edge. With more, most places have all that is near them in one cell; with fewer, a
    /// cell holds less.
    static constexpr double kWithinsPerCell = 4.0;

    Cell cellOf(const Vec3& place) const
    {
        const auto along = [&](double x) {
            return static_cast<std::int64_t>(std::floor(x * perCell_));
        };
        return {along(place.x()), along(place.y()), along(place.z())};
    }
    std::size_t slotOf(const Cell& cell) const;
    void link(std::size_t i);
    void grow();

    double within_, perCell_;           // [m], [1/m]
    std::vector<Vec3> places_;          // by number [m]
    std::vector<std::uint32_t> next_;   // by number: another one of the same slot
    std::vector<std::uint32_t> first_;  // per slot; a power of two of them
};

}  // namespace scree
