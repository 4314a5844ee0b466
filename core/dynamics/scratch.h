// What the passes of one step of method `paper` share and reuse from step to step. Everything here
// is derived: dropping it between two steps changes nothing but time.
#pragma once

#include <cstdint>
#include <vector>

#include "core/collision/interference.h"
#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/candidates.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// How often the two bodies of a pair had been moved by impulses when something about the pair was
/// found out: as long as the counts are the same, it is known.  [A15]
struct SkipStamp {
    std::uint32_t a = ~0u, b = ~0u;
    friend bool operator==(const SkipStamp&, const SkipStamp&) = default;
};

/// A pair that may meet in this step.
struct PairRecord {
    BodyPair bodies;
    double tau = 0.0;                          ///< contour value [m]  [A7]
    double friction = 0.0, restitution = 0.0;  ///< of the pair  [A27]
    RollingFriction rolling;                   ///< of the pair  [A27, A49]
    bool aIsUnmoved = false;  ///< b may not move a: of infinite mass in this pair  [A57]
    bool bIsUnmoved = false;
    bool interferesNow = false;  ///< at the common predicted positions of this collision iteration
    bool aFallsOnB = false;      ///< moved by its own fall alone, a interferes with b  [A36]
    bool bFallsOnA = false;
    bool aLeavesB = false;  ///< a falls on b, but away from it: they overlap already
    bool bLeavesA = false;
    bool isTouched = false;  ///< in the set P: contact may process it  [A26]
    SkipStamp searched;      ///< interferesNow is known for this state of the bodies
    SkipStamp quiet;         ///< in this state a visit by contact had nothing to do
    Proximity proximity;
    double depth = 0.0;  ///< where the step ends, by findWorstOverlap [m]

    /// What the step has applied so far at one sample; noted for an observer only.
    struct NotedImpulse {
        std::int32_t sample;
        bool sampleOnA;
        ContactSeen seen;
    };
    bool isWatched = false;
    std::vector<NotedImpulse> impulses;
};

/// Pairs that one thread looks at together.
inline constexpr std::size_t kPairGrain = 16;

struct StepScratch {
    bool isWatched = false;  // an observer wants to see the impulses
    Candidates candidates;
    std::vector<Aabb> reached;      // per body: by both predictions
    std::vector<PairRecord> pairs;  // sorted by bodies
    std::size_t pairCount = 0;      // records in use; the others keep their memory
    std::vector<PairRecord> formerPairs;
    std::vector<std::size_t> pairOrder;  // order of processing  [A21]
    std::vector<std::size_t> rank;       // per body: its place in World::order

    std::vector<AppliedForce> forces;  // per body, throughout the step
    std::vector<std::uint32_t> moves;  // per body: impulses received in this step
    std::vector<PassInertia> inertia;  // per body, at the current orientation
    std::vector<Pose> fallPose;        // per body: predicted with gravity
    std::vector<Pose> driftPose;       // per body: predicted without
};

/// Finds the forces, the pairs that may meet in the `remaining` time of the frame, and lays their
/// records out.
void findPairs(const World& world, const StepSettings& settings, double remaining,
               StepScratch& scratch);

/// Sets margins for a step of dt and forgets what was known of the pairs.
void beginStep(const World& world, const StepSettings& settings, double dt, StepScratch& scratch);

/// Adds pairs for bodies that impulses have made faster than the swept boxes allow. The set of
/// pairs only grows and what is known of the old ones stays.
void widenPairs(const World& world, const StepSettings& settings, double dt, StepScratch& scratch);

/// Both predictions of one body from its present velocities; those of a body that cannot be moved
/// are set by beginStep and stay, so that threads may share it.
void predictBody(const World& world, const StepSettings& settings, double dt, BodyId body,
                 StepScratch& scratch);

/// The stamp of a pair as its bodies are.
inline SkipStamp stampOf(const PairRecord& pair, const StepScratch& scratch)
{
    return {scratch.moves[pair.bodies.a], scratch.moves[pair.bodies.b]};
}

/// After an impulse between the pair: predicts both bodies and lets their stamps be known as old.
void predictAfterImpulse(const World& world, const StepSettings& settings, double dt,
                         BodyPair bodies, StepScratch& scratch);

/// The two bodies of a pair elsewhere than they are.
inline PlacedPair placePair(const World& world, const PairRecord& pair, const Pose& worldFromA,
                            const Pose& worldFromB)
{
    return {&world.shapeOf(pair.bodies.a), &world.shapeOf(pair.bodies.b), worldFromA, worldFromB};
}

}  // namespace scree
