#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace scree {
namespace {

int chosenThreads = 1;
std::unique_ptr<tbb::global_control> control;

}  // namespace

void setThreadCount(int count)
{
    chosenThreads = std::max(count, 1);
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(chosenThreads));
}

int threadCount()
{
    return chosenThreads;
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body)
{
    if (count == 0) return;
    if (chosenThreads == 1 || count <= grain) {
        body(0, count);
        return;
    }
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); },
        tbb::simple_partitioner());
}

}  // namespace scree
