#include "core/diagnostics/state_hash.h"

#include <algorithm>
#include <array>
#include <bit>
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

/// Field by field: a struct may have padding, whose bytes mean nothing.
class Fields {
public:
    Fields& add(double number)
    {
        words_[count_++] = std::bit_cast<std::uint64_t>(number);
        return *this;
    }
    Fields& add(std::uint64_t number)
    {
        words_[count_++] = number;
        return *this;
    }
    Fields& add(std::int32_t first, std::int32_t second)
    {
        return add(std::uint64_t{static_cast<std::uint32_t>(first)} << 32 |
                   static_cast<std::uint32_t>(second));
    }
    Fields& add(const Vec3& v) { return add(v.x()).add(v.y()).add(v.z()); }
    Fields& add(const Quat& q) { return add(q.w()).add(q.x()).add(q.y()).add(q.z()); }

    std::uint64_t hash(std::uint64_t seed) const
    {
        return hashBytes(words_.data(), count_ * sizeof(std::uint64_t), seed);
    }

private:
    std::array<std::uint64_t, 32> words_;
    std::size_t count_ = 0;
};

std::uint64_t hashOf(const BodyMotion& m, std::uint64_t seed)
{
    return Fields()
        .add(m.position)
        .add(m.orientation)
        .add(m.velocity)
        .add(m.angularMomentum)
        .hash(seed);
}

std::uint64_t hashOf(const RememberedContact& c, std::uint64_t seed)
{
    return Fields().add(c.a, c.b).add(c.feature).add(c.place).add(c.force).add(c.couple).hash(seed);
}

std::uint64_t hashOf(const BodyRest& rest, std::uint64_t seed)
{
    return Fields()
        .add(rest.still.position)
        .add(rest.still.orientation)
        .add(rest.nearby.position)
        .add(rest.nearby.orientation)
        .add(rest.around.position)
        .add(rest.around.orientation)
        .add(rest.pull)
        .add(rest.still.frames, rest.nearby.frames)
        .add(rest.around.frames, rest.unbalancedFrames)
        .add(std::uint64_t{rest.isAsleep})
        .hash(seed);
}

}  // namespace

std::uint64_t stateHash(const World& world)
{
    const auto hashAll = [](const auto& items, std::uint64_t seed) {
        return hashInParts(items.size(), seed, [&](std::size_t i, std::uint64_t before) {
            return hashOf(items[i], before);
        });
    };
    std::uint64_t hash = hashAll(world.motion, 0);
    hash = hashBytes(world.order.data(), world.order.size() * sizeof(BodyId), hash);
    if (!world.births.empty()) {
        hash = hashBytes(world.bornAt.data(), world.bornAt.size() * sizeof(std::int32_t), hash);
    }
    hash = hashAll(world.contactMemory.contacts, hash);
    hash = hashAll(world.contactMemory.rest, hash);
    hash = hashBytes(&world.contactMemory.dt, sizeof(double), hash);
    const std::array<std::int64_t, 2> steps = {world.clock.frame, world.clock.subStep};
    hash = hashBytes(steps.data(), sizeof steps, hash);
    return hashBytes(&world.clock.frameTimeDone, sizeof(double), hash);
}

}  // namespace scree
