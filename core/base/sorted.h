// Lists that hold each thing once, in order: what a loop over one adds up has the same bits in
// every run.
#pragma once

#include <algorithm>
#include <vector>

namespace scree {

template <class Item>
void sortUnique(std::vector<Item>& items)
{
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace scree
