// A block that slides, held against theory at every step: used by E1 (b) and E2.
#pragma once

#include "tools/verify/shot_run.h"

namespace scree::verify {

/// What Coulomb asks of a block on a slope.
struct SlideTheory {
    double degrees = 30.0, friction = 0.3, startSpeed = 0.0;

    double acceleration() const;      ///< along the slope, downhill [m/s²]
    double stopTime() const;          ///< when it is slowed to a halt [s], else 1e300
    double speed(double t) const;     ///< [m/s]
    double distance(double t) const;  ///< [m]
    Vec3 downhill() const;            ///< unit vector
};

/// Largest deviations of any step, and the curves.
struct SlideErrors {
    double position = 0.0, discretePosition = 0.0, slidingSpeed = 0.0, restSpeed = 0.0;
    double rotation = 0.0, drift = 0.0, distance = 0.0;
    Curve measured, theory;  // distance over time
};

/// Slides the body "block" of the run for two seconds.
SlideErrors slide(ShotRun& run, const SlideTheory& theory, double stepsPerSecond);

/// The same in frames whose steps the shot's settings choose; the method's own sum is not formed.
SlideErrors slideInFrames(ShotRun& run, const SlideTheory& theory);

/// What E2 demands of a slide, the error of the distance a `share` of it.
void addSlideRows(const std::string& where, const SlideErrors& errors, double share,
                  Findings& findings);

}  // namespace scree::verify
