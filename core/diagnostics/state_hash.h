// Hash of all that moves: two runs are equal when their hashes are equal at every frame.  [A21]
#pragma once

#include <cstdint>

namespace scree {

class World;

/// Over the bits of every body's motion, the order and the clock.
std::uint64_t stateHash(const World& world);

}  // namespace scree
