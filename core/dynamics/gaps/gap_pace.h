// How fast two bodies may close the gaps between them.  [algorithm 14.1]
//
// Surfaces meet only where both bodies are, and there one moves against the other as one rigid body
// does. What rolls on another, or turns beside it with its far end elsewhere, closes gaps more
// slowly than both speeds and both spins add up to: bones that pour through a funnel are looked for
// three quarters as far, and a step takes five sixths of the time.
#pragma once

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// What may close gaps of a body, as scratch.bodies tell.
GapPace paceOf(const World& world, const GapScratch& scratch, BodyId body, double dt);

/// How a rigid body moves in a step: its centre of mass, and about it.
struct RigidMotion {
    Vec3 shift, turn;  ///< [m], [rad]
};

/// How far the surfaces of two bodies, where they may touch within a step, move against each other
/// in it, at most [m]. What is round turns in itself.
double farthestApproach(const World& world, BodyPair bodies, const RigidMotion& ofA,
                        const RigidMotion& ofB);

}  // namespace scree
