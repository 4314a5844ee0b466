#include "core/dynamics/pair_visits.h"

namespace scree {

WorkOrder orderOf(const World& world, const StepScratch& scratch,
                  const std::vector<PairVisit>& visits)
{
    constexpr std::uint32_t kNone = WorkOrder::kNone;
    WorkOrder order{std::vector(visits.size(), std::array{kNone, kNone}),
                    std::vector<std::uint8_t>(visits.size(), 0)};
    std::vector<std::uint32_t> last(world.bodyCount(), kNone);  // visit of each body
    for (std::uint32_t i = 0; i < visits.size(); ++i) {
        const BodyPair& bodies = scratch.pairs[visits[i].pair].bodies;
        for (const BodyId body : {bodies.a, bodies.b}) {
            if (!world.mass[body].isMovable()) continue;
            const std::uint32_t before = last[body];
            last[body] = i;
            if (before == kNone) continue;
            auto& followers = order.followers[before];
            if (followers[0] == i) continue;  // they share both bodies
            followers[followers[0] == kNone ? 0 : 1] = i;
            ++order.predecessors[i];
        }
    }
    return order;
}

}  // namespace scree
