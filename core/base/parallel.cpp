#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "core/base/thread_team.h"

namespace scree {
namespace {

int chosenThreads = 1;
std::unique_ptr<tbb::global_control> control;  // of TBB
std::unique_ptr<ThreadTeam> team;              // where there are several threads

}  // namespace

void setThreadCount(int count)
{
    team.reset();
    chosenThreads = 1;
    if (count > 1) team = std::make_unique<ThreadTeam>(count);
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
    if (!team || count <= grain || !team->share(count, grain, body)) body(0, count);
}

void parallelInOrder(const WorkOrder& order, const std::function<void(std::size_t item)>& work)
{
    if (chosenThreads == 1) {
        for (std::size_t item = 0; item < order.size(); ++item) work(item);
        return;
    }
    std::vector<std::atomic<std::uint8_t>> waitsFor(order.size());
    std::vector<std::uint32_t> first;
    for (std::uint32_t item = 0; item < order.size(); ++item) {
        waitsFor[item] = order.predecessors[item];
        if (order.predecessors[item] == 0) first.push_back(item);
    }
    tbb::parallel_for_each(first, [&](std::uint32_t item, tbb::feeder<std::uint32_t>& feeder) {
        work(item);
        for (const std::uint32_t follower : order.followers[item]) {
            if (follower != WorkOrder::kNone && --waitsFor[follower] == 0) feeder.add(follower);
        }
    });
}

void onOneThread(const std::function<void()>& work)
{
    tbb::task_arena(1).execute(work);
}

}  // namespace scree
