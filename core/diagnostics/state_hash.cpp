#include "core/diagnostics/state_hash.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/scene/world.h"

namespace scree {

namespace {

/// Part by part: they are by far the most there is.
std::uint64_t hashOfContacts(const std::vector<RememberedContact>& contacts, std::uint64_t seed)
{
    constexpr std::size_t kTogether = 512;
    std::vector<std::uint64_t> hashes((contacts.size() + kTogether - 1) / kTogether);
    forEach(hashes.size(), 1, [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kTogether, contacts.size());
        for (std::size_t i = part * kTogether; i < end; ++i) {
            const Vec3 &f = contacts[i].force, &c = contacts[i].couple;
            const std::array<double, 6> load = {f.x(), f.y(), f.z(), c.x(), c.y(), c.z()};
            hashes[part] = hashBytes(load.data(), sizeof load, hashes[part]);
        }
    });
    return hashBytes(hashes.data(), hashes.size() * sizeof(std::uint64_t), seed);
}

}  // namespace

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
    hash = hashOfContacts(world.contactMemory.contacts, hash);
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
