// Asking for memory before it is needed. What lies scattered in memory is in no cache in a large
// world, and each miss is a hundred nanoseconds of waiting that work on something else can fill.
#pragma once

#include <cstddef>
#include <vector>

namespace scree {

/// Lines of the cache from `begin` up to `end`.
inline void fetchLines(const void* begin, const void* end)
{
    constexpr std::ptrdiff_t kLine = 64;
    // Without it g++ 12 takes this for a function that does nothing, and leaves out its calls.
    asm volatile("");
    for (auto p = static_cast<const char*>(begin); p < end; p += kLine) __builtin_prefetch(p);
}

/// What a list holds.
template <class Item>
void fetchItems(const std::vector<Item>& list)
{
    fetchLines(list.data(), list.data() + list.size());
}

}  // namespace scree
