#include "tools/verify/incline.h"

#include <algorithm>
#include <cmath>

#include "core/math/rotation.h"

namespace scree::verify {

double SlideTheory::acceleration() const
{
    const double angle = degrees * kPi / 180.0;
    return 9.8 * (std::sin(angle) - friction * std::cos(angle));
}

double SlideTheory::stopTime() const
{
    return acceleration() < 0.0 ? -startSpeed / acceleration() : 1e300;
}

double SlideTheory::speed(double t) const
{
    return t < stopTime() ? startSpeed + acceleration() * t : 0.0;
}

double SlideTheory::distance(double t) const
{
    const double moving = std::min(t, stopTime());
    return startSpeed * moving + 0.5 * acceleration() * moving * moving;
}

Vec3 SlideTheory::downhill() const
{
    const double angle = degrees * kPi / 180.0;
    return {std::cos(angle), -std::sin(angle), 0.0};
}

SlideErrors slide(ShotRun& run, const SlideTheory& theory, double stepsPerSecond)
{
    const BodyId block = run.body("block");
    const BodyMotion start = run.world.motion[block];
    const double dt = 1.0 / stepsPerSecond, stop = theory.stopTime();
    SlideErrors errors;
    errors.measured.name = "measured";
    errors.theory = {"theory", {}, {}, true};
    double discrete = 0.0;
    run.advance(2.0, stepsPerSecond, [&](const StepReport&, double t) {
        const double v = theory.speed(t), s = theory.distance(t);
        // Positions use the new velocities: the method's own sum, first order in dt.  [A18]
        discrete += dt * v;
        const BodyMotion& motion = run.world.motion[block];
        const Vec3 moved = motion.position - start.position;
        const double along = moved.dot(theory.downhill());
        const double speedError = std::abs(motion.velocity.dot(theory.downhill()) - v);
        errors.position = std::max(errors.position, std::abs(along - s));
        errors.discretePosition = std::max(errors.discretePosition, std::abs(along - discrete));
        // The step in which the block stops belongs to neither side.
        if (t < stop - dt) errors.slidingSpeed = std::max(errors.slidingSpeed, speedError);
        if (t > stop + dt) errors.restSpeed = std::max(errors.restSpeed, speedError);
        const Quat turn = start.orientation.conjugate() * motion.orientation;
        errors.rotation = std::max(errors.rotation, 2.0 * turn.vec().norm());
        errors.drift = std::max(errors.drift, std::abs(moved.z()));
        errors.distance = s;
        errors.measured.x.push_back(t);
        errors.measured.y.push_back(along);
        errors.theory.x.push_back(t);
        errors.theory.y.push_back(s);
    });
    return errors;
}

}  // namespace scree::verify
