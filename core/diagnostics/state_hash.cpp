#include "core/diagnostics/state_hash.h"

#include <array>

#include "core/base/hash.h"
#include "core/scene/world.h"

namespace scree {

std::uint64_t stateHash(const World& world)
{
    std::uint64_t hash = 0;
    for (const BodyMotion& m : world.motion) {
        // Field by field: a struct may have padding, whose bytes mean nothing.
        const std::array<double, 13> state = {
            m.position.x(),       m.position.y(),    m.position.z(),        m.orientation.w(),
            m.orientation.x(),    m.orientation.y(), m.orientation.z(),     m.velocity.x(),
            m.velocity.y(),       m.velocity.z(),    m.angularMomentum.x(), m.angularMomentum.y(),
            m.angularMomentum.z()};
        hash = hashBytes(state.data(), sizeof state, hash);
    }
    hash = hashBytes(world.order.data(), world.order.size() * sizeof(BodyId), hash);
    if (!world.births.empty()) {
        hash = hashBytes(world.bornAt.data(), world.bornAt.size() * sizeof(std::int32_t), hash);
    }
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        hash = hashBytes(contact.force.data(), sizeof(Vec3), hash);
        hash = hashBytes(contact.couple.data(), sizeof(Vec3), hash);
    }
    for (const BodyRest& rest : world.contactMemory.rest) {
        const std::array<std::int32_t, 3> still = {rest.still.frames, rest.nearby.frames,
                                                   rest.isAsleep};
        hash = hashBytes(still.data(), sizeof still, hash);
    }
    const std::array<std::int64_t, 2> steps = {world.clock.frame, world.clock.subStep};
    hash = hashBytes(steps.data(), sizeof steps, hash);
    return hashBytes(&world.clock.frameTimeDone, sizeof(double), hash);
}

}  // namespace scree
