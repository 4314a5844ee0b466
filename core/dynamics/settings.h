// Every tunable of the method, with unit, default and what goes wrong at the extremes. Shot files
// use nearly the same words (io/shot_solver.cpp).  [A16, section 12]
#pragma once

#include <cstdint>

#include "core/math/types.h"
#include "core/scene/pair_rules.h"

namespace scree {

/// How orientation is advanced from the angular momentum.  [A19]
enum class OrientationUpdate {
    euler,        ///< the paper's: gains energy when tumbling
    secondOrder,  ///< one more 3-vector solve, error of third order per step
    symplectic,   ///< energy does not drift, and symmetric bodies turn exactly
};

/// How a colliding pair is worked on.  [A24, A25]
enum class CollisionVariant {
    reevolve,  ///< both bodies are predicted anew after every impulse
    lagged,    ///< samples, normals and levers are found once per visit: faster, coarser
};

/// What an impulse is when neither sticking nor sliding is admissible.  [A33]
enum class FrictionFallback {
    blend,         ///< as much of sticking as cone and energy allow
    plainKinetic,  ///< the paper's sliding formula, whatever it does to the energy
};

/// How long a step may be.  [A16]
struct SubstepLimits {
    int min = 1;    ///< per frame [-]
    int max = 256;  ///< per frame [-]; reaching it is reported, fast thin bodies may tunnel then
    double safety = 0.5;  ///< [-]; 1 is twice as fast and misses more, small is slow and safe
};

/// Which passes a step is made of.
enum class Method {
    paper,  ///< [GBF03] but for the repairs of makeStrict: the reference
    scree,  ///< the same pipeline on gaps: contacts known before they touch, impulses remembered
};

/// How hard each phase works. Defaults follow [GBF03], but for the orientation.
struct StepSettings {
    Vec3 gravity = {0.0, -9.81, 0.0};  ///< [m/s²]
    Method method = Method::paper;
    int collisionIterations = 5;     ///< sweeps over pairs [-]; too few: fast heaps overlap
    int collisionPairImpulses = 20;  ///< per visit of a pair [-]
    bool shockPropagation = true;    ///< without it tall stacks sink and fall
    bool pushOut = true;             ///< first-order removal of overlap that is left
    int pushOutLevelIterations = 4;  ///< gradual: fraction l/n of the depth in iteration l [-]
    OrientationUpdate orientation = OrientationUpdate::symplectic;
    CombineRule frictionRule = CombineRule::maximum;     ///< of a pair, from its materials  [A27]
    CombineRule restitutionRule = CombineRule::minimum;  ///< likewise

    SubstepLimits substeps;
    double maximumSpinPerStep =
        0.3;  ///< rotation in one step, whatever safety is; blurs may more [rad]  [A16 beta]

    // Of method `scree` alone.
    bool sleep = true;   ///< what no step moves is not stepped
    int gapSweeps = 12;  ///< over all contacts of a large heap [-]; too few: it sinks

    // Of method `paper` alone.
    std::uint64_t seed = 1;       ///< of the order of processing
    int contactIterations = 10;   ///< sweeps over levels [-]; 0 makes bodies weightless to others
    int levelIterations = 2;      ///< per level and sweep [-]
    int pairImpulses = 20;        ///< per visit of a pair in contact [-]; too few: bodies rock
    int shockPairImpulses = 10;   ///< per visit of a pair in the shock sweep [-]
    int pushOutPairImpulses = 5;  ///< per visit of a pair [-]
    CollisionVariant collision = CollisionVariant::reevolve;
    double hoverLimit = 5e-4;        ///< resting gap as a fraction of the inner thickness [-]
    bool freezeUnsupported = false;  ///< shock also freezes what rests on nothing fixed: the
                                     ///< paper's, and it makes momentum out of nothing  [A47]
    FrictionFallback frictionFallback = FrictionFallback::blend;
    bool skipStamps = true;  ///< do not test again what cannot have changed: only time  [A15]
    /// A contact of a smooth mesh slides along it to where it is deepest now; without it a rolling
    /// body is braked.  [A40]
    bool slideSmoothSamples = true;
    bool curvatureScaling = true;  ///< rolling resistance grows where curvature is low  [A50]
};

/// The paper without the repairs documented beside it; shapes want FieldMode::grid with it.  [A60]
void makeStrict(StepSettings& settings);

}  // namespace scree
