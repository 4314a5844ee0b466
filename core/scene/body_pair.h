// Two bodies of a world.
#pragma once

#include <compare>

#include "core/scene/body.h"

namespace scree {

/// The broad phase, and all that remembers pairs, has a < b.
struct BodyPair {
    BodyId a = 0, b = 0;
    friend bool operator==(const BodyPair&, const BodyPair&) = default;
    friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

}  // namespace scree
