// What method `scree` remembers from one step to the next: the forces in its contacts, and who lies
// still. It is state: a resumed run that had forgotten it would not go on to the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/body_pair.h"

namespace scree {

/// The force that a place of contact needed in the last step. What held a heap then holds it now.
struct RememberedContact {
    BodyId a = 0, b = 0;
    std::uint64_t feature = 0;   ///< contact_with_gap.h
    Vec3 place = Vec3::Zero();   ///< in A's object frame [m]
    Vec3 force = Vec3::Zero();   ///< on A, world [N]
    Vec3 couple = Vec3::Zero();  ///< of its resistance to rolling and spinning, on A, world [N m]
};

/// By these what is remembered is sorted.
inline BodyPair bodiesOf(const RememberedContact& contact)
{
    return {contact.a, contact.b};
}

/// A place that a body has not left for some frames.
struct Stay {
    Vec3 position = Vec3::Zero();         ///< where it was when it was last seen to leave [m]
    Quat orientation = Quat::Identity();  ///< likewise
    std::int32_t frames = -1;             ///< −1: it has not been seen anywhere yet
};

/// Since when a body has not moved, and whether it sleeps.
struct BodyRest {
    Stay still;                ///< it does not move at all
    Stay nearby;               ///< it may rock, but goes nowhere
    Stay around;               ///< the same, as wide as a bowl rocks on its round bottom
    Vec3 pull = Vec3::Zero();  ///< what acted on it when it fell asleep, or last [m/s²]
    bool isAsleep = false;
    std::int32_t unbalancedFrames = 0;  ///< for so many it has slept under what did not balance
};

struct ContactMemory {
    std::vector<RememberedContact> contacts;  ///< sorted by bodies
    std::vector<BodyRest> rest;               ///< per body; empty before the first frame
    double dt = 0.0;                          ///< of the last step [s]; 0: there was none

    bool isAsleep(BodyId body) const
    {
        const auto i = static_cast<std::size_t>(body);
        return i < rest.size() && rest[i].isAsleep;
    }
};

}  // namespace scree
