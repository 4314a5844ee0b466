// Pairs that may meet in the rest of a frame: what the length of a step is chosen by, in either
// method, and whom the paper's method looks at.  [A14, A16]
#pragma once

#include <vector>

#include "core/collision/broad_phase.h"
#include "core/dynamics/forces.h"
#include "core/scene/world.h"

namespace scree {

struct Candidates {
    BroadPhase broadPhase;
    std::vector<Aabb> sweptBoxes;  ///< per body: all it may reach in the rest of the frame
    std::vector<BodyPair> pairs;  ///< whose boxes meet, that may collide, and of which one moves by
                                  ///< itself; sorted
};

/// Finds those for the `remaining` time [s] under `forces`, per body. Keyed bodies are swept along
/// their scripts.
void findCandidates(const World& world, const std::vector<AppliedForce>& forces, double remaining,
                    Candidates& candidates);

/// Adds those of bodies that impulses have made reach farther than their boxes, for `time` more
/// [s]; answers whether there is such a body.
bool widenCandidates(const World& world, const std::vector<AppliedForce>& forces,
                     const std::vector<Aabb>& reached, double time, Candidates& candidates);

}  // namespace scree
