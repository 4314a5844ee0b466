#include "core/diagnostics/state_hash.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/scene/world.h"

namespace scree {

namespace {

/// Of hashOne(index, hash) for all indices, part by part: by several threads.
template <class HashOne>
std::uint64_t hashInParts(std::size_t count, std::uint64_t seed, const HashOne& hashOne)
{
    constexpr std::size_t kTogether = 128;
    std::vector<std::uint64_t> hashes((count + kTogether - 1) / kTogether);
    forEach(hashes.size(), 1, [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kTogether, count);
        for (std::size_t i = part * kTogether; i < end; ++i)
            hashes[part] = hashOne(i, hashes[part]);
    });
    return hashBytes(hashes.data(), hashes.size() * sizeof(std::uint64_t), seed);
}

// Field by field: a struct may have padding, whose bytes mean nothing.

std::uint64_t hashOf(const BodyMotion& m, std::uint64_t seed)
{
    const std::array<double, 13> state = {
        m.position.x(),       m.position.y(),    m.position.z(),        m.orientation.w(),
        m.orientation.x(),    m.orientation.y(), m.orientation.z(),     m.velocity.x(),
        m.velocity.y(),       m.velocity.z(),    m.angularMomentum.x(), m.angularMomentum.y(),
        m.angularMomentum.z()};
    return hashBytes(state.data(), sizeof state, seed);
}

std::uint64_t hashOf(const RememberedContact& contact, std::uint64_t seed)
{
    const Vec3 &f = contact.force, &c = contact.couple;
    const std::array<double, 6> load = {f.x(), f.y(), f.z(), c.x(), c.y(), c.z()};
    return hashBytes(load.data(), sizeof load, seed);
}

}  // namespace

std::uint64_t stateHash(const World& world)
{
    const std::vector<RememberedContact>& contacts = world.contactMemory.contacts;
    std::uint64_t hash = hashInParts(world.bodyCount(), 0, [&](std::size_t i, std::uint64_t seed) {
        return hashOf(world.motion[i], seed);
    });
    hash = hashBytes(world.order.data(), world.order.size() * sizeof(BodyId), hash);
    if (!world.births.empty()) {
        hash = hashBytes(world.bornAt.data(), world.bornAt.size() * sizeof(std::int32_t), hash);
    }
    hash = hashInParts(contacts.size(), hash, [&](std::size_t i, std::uint64_t seed) {
        return hashOf(contacts[i], seed);
    });
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
