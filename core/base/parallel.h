// Work shared by threads, with results that do not depend on how many there are.
#pragma once

#include <cstddef>
#include <functional>

namespace scree {

/// Threads used by parallelFor from now on; at least 1.
void setThreadCount(int count);
int threadCount();

/// Calls body(begin, end) for consecutive ranges that together cover 0 … count − 1, each index
/// once. Ranges are about `grain` long. The body must write only what belongs to its own indices:
/// then any number of threads gives the same bits.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace scree
