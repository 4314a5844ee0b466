// Work shared by threads, with results that do not depend on how many there are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace scree {

/// Threads used by parallelFor from now on; at least 1. Throws Error{usage} when the system allows
/// fewer.
void setThreadCount(int count);
int threadCount();

/// Calls body(begin, end) for consecutive ranges that together cover 0 … count − 1, each index
/// once. Ranges are about `grain` long. The body must write only what belongs to its own indices:
/// then any number of threads gives the same bits. What it throws comes out of here. A loop inside
/// of a range is done by the thread of that range.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

/// A grain for work of a tenth of a microsecond or so.
inline constexpr std::size_t kShortWork = 64;

/// Calls work(i) for every i from 0 to count − 1, `grain` of them together.
template <class Work>
void forEach(std::size_t count, std::size_t grain, const Work& work)
{
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
    });
}

/// Items of work in an order of which only part matters: some must follow others, and the bits are
/// those of one after the other as long as they do.
struct WorkOrder {
    /// Up to two items, later ones, that must follow each directly; kNone where there is none.
    std::vector<std::array<std::uint32_t, 2>> followers;
    std::vector<std::uint8_t> predecessors;  ///< how many name each as a follower

    static constexpr std::uint32_t kNone = ~0u;
    std::size_t size() const { return followers.size(); }
};

/// Calls work(item) once for every item, after all that it must follow.
void parallelInOrder(const WorkOrder& order, const std::function<void(std::size_t item)>& work);

/// Runs `work` without letting it share itself out: for libraries whose results depend on how many
/// threads they use. Told to use one thread themselves, some of them (Embree) tie the whole process
/// to one.
void onOneThread(const std::function<void()>& work);

}  // namespace scree
