// What the passes of one step share and reuse from step to step. Everything here is derived:
// dropping it between two steps changes nothing but time.
#pragma once

#include <vector>

#include "core/collision/broad_phase.h"
#include "core/collision/interference.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// A pair that may meet in this step.
struct PairRecord {
    BodyPair bodies;
    double tau = 0.0;                          ///< contour value [m]  [A7]
    double friction = 0.0, restitution = 0.0;  ///< of the pair  [A27]
    RollingFriction rolling;                   ///< of the pair  [A27, A49]
    bool interferesNow = false;  ///< at the common predicted positions of this collision iteration
    bool aFallsOnB = false;      ///< moved by its own fall alone, a interferes with b  [A36]
    bool bFallsOnA = false;
    bool aLeavesB = false;  ///< a falls on b, but away from it: they overlap already
    bool bLeavesA = false;
    bool isTouched = false;  ///< in the set P: contact may process it  [A26]
    Proximity proximity;
};

struct StepScratch {
    BroadPhase broadPhase;
    std::vector<Aabb> sweptBoxes;        // per body: all it may reach in the rest of the frame
    std::vector<PairRecord> pairs;       // sorted by bodies
    std::size_t pairCount = 0;           // records in use; the others keep their memory
    std::vector<std::size_t> pairOrder;  // order of processing  [A21]
    std::vector<std::size_t> rank;       // per body: its place in World::order

    std::vector<PassInertia> inertia;  // per body, at the current orientation
    std::vector<Pose> fallPose;        // per body: predicted with gravity
    std::vector<Pose> driftPose;       // per body: predicted without
};

/// The world box of a placed shape; a plane's is everything.
Aabb boxAt(const Shape& shape, const Pose& pose);

/// Lays out the pairs for a step that lasts dt of the `remaining` time of the frame.
void findPairs(const World& world, const StepSettings& settings, double remaining,
               StepScratch& scratch);

/// Sets margins for a step of dt and forgets what was known of the pairs.
void beginStep(const World& world, const StepSettings& settings, double dt, StepScratch& scratch);

/// Adds pairs for bodies that impulses have made faster than the swept boxes allow. The set of
/// pairs only grows and what is known of the old ones stays.
void widenPairs(const World& world, const StepSettings& settings, double dt, StepScratch& scratch);

/// Order of processing: by the place of the later body in World::order, then of the earlier.  [A21]
void sortPairs(const World& world, StepScratch& scratch);

/// Both predictions of one body from its present velocities; those of a body that cannot be moved
/// are set by beginStep and stay, so that threads may share it.
void predictBody(const World& world, const StepSettings& settings, double dt, BodyId body,
                 StepScratch& scratch);

inline PlacedPair placePair(const World& world, const PairRecord& pair, const Pose& worldFromA,
                            const Pose& worldFromB)
{
    return {&world.shapeOf(pair.bodies.a), &world.shapeOf(pair.bodies.b), worldFromA, worldFromB};
}

}  // namespace scree
