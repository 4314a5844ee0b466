#include "tools/stoppable_fields.h"

#include "tools/stop_signals.h"

namespace scree {

std::optional<DistanceField> StoppableFields::find(std::uint64_t key)
{
    heedSignals();
    return fields_.find(key);
}

void StoppableFields::keep(std::uint64_t key, const DistanceField& field)
{
    fields_.keep(key, field);
    heedSignals();
}

void StoppableFields::heedSignals()
{
    heedStop();
    if (takeSaveRequest())
        console_.answer("scree: still building distance fields; there is nothing to save yet");
}

}  // namespace scree
