#include "tools/stoppable_store.h"

#include "tools/stop_signals.h"

namespace scree {

std::optional<DistanceField> StoppableStore::findField(std::uint64_t key)
{
    heedSignals();
    return store_.findField(key);
}

void StoppableStore::keepField(std::uint64_t key, const DistanceField& field)
{
    store_.keepField(key, field);
    heedSignals();
}

std::optional<TriMesh> StoppableStore::findSolid(std::uint64_t key)
{
    heedSignals();
    return store_.findSolid(key);
}

void StoppableStore::keepSolid(std::uint64_t key, const TriMesh& solid)
{
    store_.keepSolid(key, solid);
    heedSignals();
}

void StoppableStore::heedSignals()
{
    const std::lock_guard guard(lock_);
    heedStop();
    if (takeSaveRequest())
        console_.answer("scree: still making the shapes; there is nothing to save yet");
}

}  // namespace scree
