// Hash of all state: two runs are equal when their hashes are equal at every frame.  [A21]
#pragma once

#include <cstdint>

namespace scree {

class World;

/// Over the bits of everything that a step reads and changes: motion, order, births, clock, and
/// what is remembered of contacts and of who lies still.
std::uint64_t stateHash(const World& world);

}  // namespace scree
