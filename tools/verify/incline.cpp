#include "tools/verify/incline.h"

#include <algorithm>
#include <cmath>

#include "core/math/rotation.h"

namespace scree::verify {

namespace {

/// Holds the block against theory at one moment. Within `blur` of the moment at which it stops its
/// speed belongs to neither side.
void look(const ShotRun& run, const SlideTheory& theory, double t, double blur, SlideErrors& errors)
{
    const BodyId block = run.body("block");
    const BodyMotion &start = run.start.motion[block], &motion = run.world.motion[block];
    const double v = theory.speed(t), s = theory.distance(t), stop = theory.stopTime();
    const Vec3 moved = motion.position - start.position;
    const double along = moved.dot(theory.downhill());
    const double speedError = std::abs(motion.velocity.dot(theory.downhill()) - v);
    errors.position = larger(errors.position, std::abs(along - s));
    if (t < stop - blur) errors.slidingSpeed = larger(errors.slidingSpeed, speedError);
    if (t > stop + blur) errors.restSpeed = larger(errors.restSpeed, speedError);
    errors.rotation = larger(errors.rotation, chordOfTurn(start.orientation, motion.orientation));
    errors.drift = larger(errors.drift, (moved - along * theory.downhill()).norm());
    errors.distance = s;
    errors.measured.x.push_back(t);
    errors.measured.y.push_back(along);
    errors.theory.x.push_back(t);
    errors.theory.y.push_back(s);
}

SlideErrors nothingSeen()
{
    SlideErrors errors;
    errors.measured.name = "measured";
    errors.theory = {"theory", {}, {}, true};
    return errors;
}

}  // namespace

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
    const double dt = 1.0 / stepsPerSecond;
    SlideErrors errors = nothingSeen();
    double discrete = 0.0;
    run.advance(2.0, stepsPerSecond, [&](const StepReport&, double t) {
        look(run, theory, t, dt, errors);
        // The paper's positions use the new velocities: its own sum, first order in dt.  [A18]
        // Method `scree` moves what slides by the mean velocity: theory itself.
        const bool isPaper = run.shot.settings.method == Method::paper;
        discrete = isPaper ? discrete + dt * theory.speed(t) : theory.distance(t);
        errors.discretePosition =
            larger(errors.discretePosition, std::abs(errors.measured.y.back() - discrete));
    });
    return errors;
}

SlideErrors slideInFrames(ShotRun& run, const SlideTheory& theory)
{
    const double frame = 1.0 / run.shot.framesPerSecond;
    SlideErrors errors = nothingSeen();
    for (int k = 1; k <= 2.0 / frame; ++k) {
        run.advanceFrames(1);
        look(run, theory, k * frame, frame, errors);
    }
    return errors;
}

void addSlideRows(const std::string& where, const SlideErrors& errors, double share,
                  Findings& findings)
{
    findings.atMost(
        Weight::must, where + ": error of the distance", errors.position, share * errors.distance,
        "m", "of " + shortNumber(errors.distance) + " m: two lines that cannot be told apart");
    findings.atMost(Weight::must, where + ": against the method's own sum", errors.discretePosition,
                    1e-4, "m");
    findings.atMost(Weight::must, where + ": error of the speed while sliding", errors.slidingSpeed,
                    1e-4, "m/s");
    if (errors.restSpeed > 0.0 || where.starts_with("decel")) {
        findings.atMost(Weight::must, where + ": speed after it stopped", errors.restSpeed, 1e-8,
                        "m/s");
    }
    findings.atMost(Weight::must, where + ": rotation", errors.rotation, 1e-3, "rad");
    findings.atMost(Weight::must, where + ": drift off the line", errors.drift, 1e-4, "m");
}

}  // namespace scree::verify
