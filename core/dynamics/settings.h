// Every tunable of the method, with unit, default and what goes wrong at the extremes. Shot files
// use the same words in snake_case.  [A16, section 12]
#pragma once

#include <cstdint>

#include "core/math/types.h"

namespace scree {

/// How orientation is advanced from the angular momentum.  [A19]
enum class OrientationUpdate {
    euler,        ///< the paper's: gains energy when tumbling
    secondOrder,  ///< one more 3-vector solve, error of third order per step
};

/// How long a step may be.  [A16]
struct SubstepLimits {
    int min = 1;    ///< per frame [-]
    int max = 256;  ///< per frame [-]; reaching it is reported, fast thin bodies may tunnel then
    double safety = 0.5;  ///< [-]; 1 is twice as fast and misses more, small is slow and safe
};

/// Which passes a step is made of.
enum class Method {
    paper,  ///< [GBF03] to the letter: the reference
    scree,  ///< the same pipeline on gaps: contacts known before they touch, impulses remembered
};

/// How hard each phase works. Defaults follow [GBF03].
struct StepSettings {
    Vec3 gravity = {0.0, -9.81, 0.0};  ///< [m/s²]
    std::uint64_t seed = 1;            ///< of the order of processing
    Method method = Method::paper;

    int collisionIterations = 5;     ///< sweeps over pairs [-]; too few: fast heaps overlap
    int collisionPairImpulses = 20;  ///< per visit of a pair [-]
    int contactIterations = 10;    ///< sweeps over levels [-]; 0 makes bodies weightless to others
    int levelIterations = 2;       ///< per level and sweep [-]
    int pairImpulses = 20;         ///< per visit of a pair in contact [-]; too few: bodies rock
    bool shockPropagation = true;  ///< without it tall stacks sink and fall
    int shockPairImpulses = 10;    ///< per visit of a pair in the shock sweep [-]
    bool pushOut = true;           ///< first-order removal of overlap that is left
    int pushOutLevelIterations = 4;  ///< gradual: fraction l/n of the depth in iteration l [-]
    int pushOutPairImpulses = 5;     ///< per visit of a pair [-]
    int gapSweeps =
        8;  ///< of method `scree`, over all contacts of a large heap [-]; too few: it sinks
    OrientationUpdate orientation = OrientationUpdate::secondOrder;
    bool slideSmoothSamples = true;  ///< off, round bodies are braked as they roll  [A40]
    bool curvatureScaling = true;    ///< rolling friction grows where surfaces fit  [A50]

    SubstepLimits substeps;
    double maximumSpinPerStep = 0.3;  ///< rotation in one step at safety 1 … [rad]  [A16 beta]
    double hoverLimit = 5e-4;         ///< resting gap as a fraction of the inner thickness [-]
};

}  // namespace scree
