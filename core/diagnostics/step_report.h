// What a step says of itself.  [A58, A59]
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/body.h"

namespace scree {

/// What decided the length of a step.
enum class StepLimit : std::uint8_t { frame, relativeSpeed, spin, hover, substepCap };

/// How impulses came out, by friction case.  [A31–A33]
struct ImpulseCounts {
    std::int64_t sticking = 0;
    std::int64_t sliding = 0;
    std::int64_t fallback = 0;        ///< neither was admissible: blended on the segment
    std::int64_t rolling = 0;         ///< sticking ones that also braked rolling or spinning  [A51]
    std::int64_t rollingDropped = 0;  ///< sticking ones whose cone left no room for that

    std::int64_t total() const { return sticking + sliding + fallback; }
    ImpulseCounts& operator+=(const ImpulseCounts& other);
};

/// The phases of a step, in the order in which they run.
enum class Phase : std::uint8_t {
    stepLimit,
    collision,
    contactGraph,
    contact,
    shock,
    position,
    pushOut,
    count
};
const char* nameOf(Phase phase);
using PhaseSeconds =
    std::array<double, static_cast<int>(Phase::count)>;  ///< wall time by phase [s]

struct StepReport {
    double dt = 0.0;  ///< [s]
    StepLimit limitedBy = StepLimit::frame;
    std::int64_t broadPairs = 0;     ///< pairs whose boxes meet
    std::int64_t touchingPairs = 0;  ///< `paper`: with interference in the collision phase, the set
                                     ///< P; `scree`: with gaps that the step may close
    std::int64_t contactPairs = 0;   ///< `paper`: that contact processes; `scree`: that bear
    std::int64_t contacts = 0;       ///< `scree`: places at which touching pairs may meet
    int levels = 0;
    int largestLevel = 0;  ///< bodies in the fullest level above 0
    ImpulseCounts collisionImpulses, contactImpulses;
    ImpulseCounts shockImpulses;  ///< `paper`: of the sweep; `scree` keeps none of them
    std::int64_t pushes = 0;
    std::int64_t loopsAtTheirCap =
        0;  ///< `paper`: visits of pairs that did; `scree`: steps whose blows, or looks, did
    std::int64_t pushesCut = 0;         ///< pushes longer than the limit allows
    double deepestBeforePushOut = 0.0;  ///< by the solver's own samples [m]
    double deepestAfterPushOut = 0.0;   ///< [m]
    double worstOverlapRatio = 0.0;     ///< largest depth / longest box edge of the smaller body
    BodyId worstA = -1, worstB = -1;    ///< the pair of worstOverlapRatio
    double pushOutWork = 0.0;           ///< potential energy that push-out added [J]
    std::vector<BodyId> nonFinite;  ///< bodies that are no longer numbers: the run must stop  [A59]
    Phase nonFinitePhase = Phase::position;  ///< the phase after which they were found
    PhaseSeconds seconds = {};
};

/// Who came into the world at a frame, and who could not.
struct BirthReport {
    int born = 0;                       ///< at this frame
    int waiting = 0;                    ///< due, but their places are taken
    int skipped = 0;                    ///< at this frame, for good
    BodyId failed = -1, occupant = -1;  ///< a body that must not wait, and who stands there
};

/// A frame in numbers: its steps summed or the worst of them.
struct FrameReport {
    int steps = 0;
    double shortestStep = 0.0, longestStep = 0.0;  ///< [s]
    StepReport
        sum;  ///< counts and seconds summed, depths, ratio and levels the largest of any step
    bool substepCapReached = false;
    BodyId fastestBody = -1;                            ///< who asked for the shortest step
    double kineticEnergy = 0.0, potentialEnergy = 0.0;  ///< at the end of the frame [J]
    Vec3 momentum = Vec3::Zero();                       ///< [kg m/s]
    Vec3 angularMomentum = Vec3::Zero();                ///< about the world's origin [kg m²/s]
    int bodiesAwake = 0;                                ///< dynamic bodies that are simulated
    BirthReport births;                                 ///< at the end of the frame
    std::uint64_t stateHash = 0;
    bool finished = true;  ///< false: stopped between two sub-steps, as asked
};

}  // namespace scree
