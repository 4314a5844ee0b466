// What an asset may hold and what reading it may cost. A shot comes from as far away as its assets,
// so no key of it changes these: who runs the program does, by flags.
#pragma once

#include <cstdint>

#include "io/confined_process.h"

namespace scree {

/// Far above what a shot can use; a file that holds more is refused.
struct ImportLimits {
    std::uint32_t points = 50'000'000;  ///< of one mesh, and triangles likewise
    std::uint32_t nodes = 100'000;      ///< that show a mesh
    std::uint32_t depth = 256;          ///< of nodes in nodes
    std::uint32_t nameLength = 1024;    ///< of a node [bytes]
    ConfinedLimits process;             ///< of the process that reads it
};

}  // namespace scree
