#include "tools/stoppable_build.h"

#include <mutex>

#include "tools/stop_signals.h"

namespace scree {
namespace {

/// Passes on to a cache what is asked of it, by several threads.
class StoppableStore : public ShapeStore {
public:
    StoppableStore(ShapeCache& cache, Console& console) : cache_(cache), console_(console) {}

    std::optional<DistanceField> findField(std::uint64_t key) override
    {
        heedSignals();
        return cache_.findField(key);
    }
    void keepField(std::uint64_t key, const DistanceField& field) override
    {
        cache_.keepField(key, field);
        heedSignals();
    }
    std::optional<TriMesh> findSolid(std::uint64_t key) override
    {
        heedSignals();
        return cache_.findSolid(key);
    }
    void keepSolid(std::uint64_t key, const TriMesh& solid) override
    {
        cache_.keepSolid(key, solid);
        heedSignals();
    }

private:
    void heedSignals()
    {
        const std::lock_guard guard(lock_);
        heedEarlySignals(console_);
    }

    ShapeCache& cache_;
    Console& console_;
    std::mutex lock_;
};

}  // namespace

void heedEarlySignals(Console& console)
{
    heedStop();
    if (takeSaveRequest())
        console.answer("scree: still making the shapes; there is nothing to save yet");
}

World buildStoppably(const Shot& shot, ShapeCache& cache, Console& console)
{
    StoppableStore store(cache, console);
    World world = buildWorld(shot, &store);
    if (!cache.problem().empty()) console.warning("cache of shapes: " + cache.problem());
    heedEarlySignals(console);
    return world;
}

}  // namespace scree
