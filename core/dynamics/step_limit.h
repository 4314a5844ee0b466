// How long a step may be. Method `paper` detects nothing between positions, so bodies that may meet
// must not pass a good part of the thinner one in a step. Method `scree` knows contacts before they
// touch, and what they are only as long as nobody has gone a good part of his size.  [A16]
#pragma once

#include <vector>

#include "core/diagnostics/step_report.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

struct StepLength {
    double dt = 0.0;  ///< [s]
    StepLimit limitedBy = StepLimit::frame;
    BodyId body = -1;         ///< who asks for it
    bool capReached = false;  ///< the limit of steps a frame forbids what the motion asks for
};

/// How thick a body is where steps are chosen [m].  [A16]
double thicknessForSteps(Method method, const Shape& shape);

/// How far two surfaces may pass each other in a step at safety 1, as far as this body is concerned
/// [m].  [A16]
double passedPerStep(Method method, const Shape& shape);

/// How many steps a frame its limit asks for where a surface of that shape passes others, no
/// thinner, at `speed` [m/s]; turns may ask for more.  [A16]
double stepsToPass(const StepSettings& settings, const Shape& shape, double speed,
                   double frameDuration);

/// How fast a free body turns what shows of that [rad/s]. What is round about an axis turns about
/// it in itself, as far as steps of method `scree` are concerned.
double shownSpin(const World& world, const StepSettings& settings, BodyId body);

/// Who may meet in the rest of a frame, and what pulls them there.
struct Prospect {
    const std::vector<BodyPair>& pairs;       ///< whose boxes, swept over that time, meet
    const std::vector<AppliedForce>& forces;  ///< per body
};

/// The next of the equal steps that fill what remains of the frame.
StepLength chooseStep(const World& world, const StepSettings& settings, double frameDuration,
                      double remaining, const Prospect& prospect);

}  // namespace scree
