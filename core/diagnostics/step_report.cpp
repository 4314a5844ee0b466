#include "core/diagnostics/step_report.h"

namespace scree {

ImpulseCounts& ImpulseCounts::operator+=(const ImpulseCounts& other)
{
    sticking += other.sticking;
    sliding += other.sliding;
    fallback += other.fallback;
    rolling += other.rolling;
    rollingDropped += other.rollingDropped;
    return *this;
}

const char* nameOf(Phase phase)
{
    switch (phase) {
        case Phase::stepLimit:
            return "step_limit";
        case Phase::collision:
            return "collision";
        case Phase::contactGraph:
            return "contact_graph";
        case Phase::contact:
            return "contact";
        case Phase::shock:
            return "shock";
        case Phase::position:
            return "position";
        case Phase::pushOut:
            return "push_out";
        case Phase::count:
            break;
    }
    return "unknown";
}

}  // namespace scree
