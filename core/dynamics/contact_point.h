// A touch seen from two placed bodies – point, levers and normal in the world – and the impulse
// there. [A39]
#pragma once

#include <vector>

#include "core/collision/interference.h"
#include "core/dynamics/scratch.h"

namespace scree {

/// S is the body that owns the sample, F the one whose field it entered; n points from F to S and u
/// is S's velocity against F's.
struct ContactPoint {
    BodyId sampleBody = 0, fieldBody = 0;
    std::int32_t sample = 0;  ///< id in its body
    Vec3 rS, rF;              ///< contact point minus centre of mass [m]
    Vec3 normal;
    Vec3 u;  ///< relative velocity [m/s]
};

/// The configurations of a pair that a contact is told in.
struct ContactFrames {
    const PlacedPair& geometry;   ///< points, levers and normal are taken here
    const PlacedPair& now;        ///< where the bodies are
    const PlacedPair& predicted;  ///< where the touch was found
};

/// Places the touch, with the bodies' present velocities; world inertias belong to frames.geometry.
/// Samples of round bodies move to where these are deepest in that configuration, unless the
/// settings forbid it.  [A40]
ContactPoint placeContact(const World& world, const PairRecord& pair, const Touch& touch,
                          const ContactFrames& frames, const Mat3& inverseInertiaA,
                          const Mat3& inverseInertiaB, const StepSettings& settings);

/// The inertias of a pair in one configuration: the bodies' own, which tell how fast their points
/// move, and those of the pass, zero where it may not move a body.
struct PairInertia {
    Mat3 ownInverseA, ownInverseB;
    PassInertia passA, passB;
};

/// An approach slower than this is none: rounding, far below what gravity adds in a step [m/s].
/// Where there is gravity that alone tells: a speed of its own would be one of larger scenes. [A29]
double slowestApproach(const StepSettings& settings, double dt);

/// Takes u from the bodies' present velocities; point and normal stay.
void updateApproach(const World& world, const PairRecord& pair, const PairInertia& inertia,
                    ContactPoint& contact);

/// Applies the impulse of one approaching contact to both bodies, with rolling friction where it
/// sticks. The contact must have been placed in these frames.
void applyContact(World& world, const StepSettings& settings, PairRecord& pair,
                  const ContactPoint& contact, const ContactFrames& frames,
                  const PairInertia& inertia, double restitution, ImpulseCounts& counts);

/// Applies the impulse of the deepest touch of the pair as placed (Proximity::place) that
/// approaches. False when there is none.
bool applyDeepest(World& world, const StepSettings& settings, PairRecord& pair,
                  const ContactFrames& frames, const PairInertia& inertia, double restitution,
                  double dt, ImpulseCounts& counts);

}  // namespace scree
