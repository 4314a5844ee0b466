// How a plank on a pivot tilts over time: used by E5 and, strictly, by E22.
#pragma once

#include "tools/verify/shot_run.h"

namespace scree::verify {

/// Tilt of the body "plank" of the run, its +x end down positive [degrees].
double tiltNow(const ShotRun& run);

/// The same over time; 240 steps a second.
Curve tiltOver(ShotRun& run, double seconds);

/// The curve's tilt so long after its beginning.
double tiltAt(const Curve& curve, double seconds);

}  // namespace scree::verify
