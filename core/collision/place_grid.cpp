#include "core/collision/place_grid.h"

#include <algorithm>

#include "core/base/hash.h"

namespace scree {
namespace {

constexpr std::size_t kFirstSlots = 256;

}  // namespace

void PlaceGrid::add(const Vec3& place)
{
    places_.push_back(place);
    next_.push_back(kNone);
    if (places_.size() > first_.size())
        grow();
    else
        link(places_.size() - 1);
}

void PlaceGrid::move(std::size_t i, const Vec3& place)
{
    std::uint32_t* toHere = &first_[slotOf(cellOf(places_[i]))];
    while (*toHere != i) toHere = &next_[*toHere];
    *toHere = next_[i];
    places_[i] = place;
    link(i);
}

std::size_t PlaceGrid::slotOf(const Cell& cell) const
{
    const auto part = [](std::int64_t c) { return static_cast<std::uint64_t>(c); };
    const std::uint64_t bits =
        mixBits(mixBits(mixBits(part(cell[0])) + part(cell[1])) + part(cell[2]));
    return bits & (first_.size() - 1);
}

void PlaceGrid::link(std::size_t i)
{
    std::uint32_t& first = first_[slotOf(cellOf(places_[i]))];
    next_[i] = first;
    first = static_cast<std::uint32_t>(i);
}

/// Makes as many slots as there may be places.
void PlaceGrid::grow()
{
    first_.assign(std::max(kFirstSlots, 2 * first_.size()), kNone);
    for (std::size_t i = 0; i < places_.size(); ++i) link(i);
}

}  // namespace scree
