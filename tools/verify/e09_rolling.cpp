// E9: rolling and spinning friction. [GBF03 “Rolling and Spinning Friction”], [A40, A49–A51]
#include <algorithm>
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

constexpr double kStep = 1.0 / 240.0;

std::vector<std::string> withResistance(double mu)
{
    return {setNumber("material.ball.rolling_friction_raw", mu),
            setNumber("material.ball.spinning_friction_raw", mu)};
}

/// A body that rolls along +x and spins about the normal.
struct Roll {
    double rollStop = 1e300, spinStop = 1e300;  ///< first time at rest [s]
    double distance = 0.0, speed = 0.0;         ///< at the end
    Vec3 reversal = Vec3::Zero();  ///< of each component of the spin, the largest rate of its
                                   ///< lesser sense [rad/s]
    Curve speeds;                  ///< over time
};

Roll roll(ShotRun& run, double seconds)
{
    Roll result;
    const BodyId ball = run.body("ball");
    Vec3 most = spinOf(run.world, ball), least = most;
    run.advance(seconds, 240.0, [&](const StepReport&, double t) {
        const Vec3 spin = spinOf(run.world, ball);
        most = most.cwiseMax(spin);
        least = least.cwiseMin(spin);
        if (std::abs(spin.z()) < 1e-9) result.rollStop = smaller(result.rollStop, t);
        if (std::abs(spin.y()) < 1e-9) result.spinStop = smaller(result.spinStop, t);
        result.speeds.x.push_back(t);
        result.speeds.y.push_back(run.world.motion[ball].velocity.x());
    });
    result.reversal = most.cwiseMin(-least).cwiseMax(0.0);
    result.distance = run.world.motion[ball].position.x();
    result.speed = run.world.motion[ball].velocity.x();
    return result;
}

/// 2 m/s less μ m g t, until it stands.
Curve speedTheory(double mu, double seconds)
{
    Curve curve{"theory", {}, {}, true};
    for (double t = 0.0; t <= seconds; t += 0.02) {
        curve.x.push_back(t);
        curve.y.push_back(std::max(0.0, 2.0 - 0.5 * mu * 2.0 * 9.8 * t));
    }
    return curve;
}

void braked(const Context& context, Findings& findings, Plot& plot)
{
    for (double mu : {0.05, 0.5}) {
        ShotRun run(context, "E09_rolling", withResistance(mu));
        Roll result = roll(run, 6.0);
        const std::string name = "coefficient " + shortNumber(mu) + ": ";
        const double rollStop = 4.0 / (mu * 2.0 * 9.8), spinStop = 3.0 / (mu * 2.0 * 9.8);
        const double distance = 0.5 * 2.0 * rollStop;
        findings.near(must, name + "stops rolling", result.rollStop, rollStop,
                      0.01 * rollStop + kStep, "s");
        findings.near(must, name + "stops spinning", result.spinStop, spinStop,
                      0.01 * spinStop + kStep, "s");
        findings.near(must, name + "rolls", result.distance, distance,
                      0.01 * distance + 2.0 * kStep, "m");
        findings.atMost(must, name + "turns back", result.reversal.maxCoeff(), 1e-10, "rad/s");
        result.speeds.name = "measured, " + shortNumber(mu) + " /(kg m)";
        plot.curves.push_back(result.speeds);
        plot.curves.push_back(speedTheory(mu, 6.0));
    }
}

void unbraked(const Context& context, Findings& findings, Plot& plot)
{
    ShotRun run(context, "E09_rolling", withResistance(0.0));
    Roll result = roll(run, 6.0);
    findings.near(must, "no rolling friction: speed after 6 s", result.speed, 2.0, 0.002, "m/s");
    findings.near(must, "no rolling friction: rolls in 6 s", result.distance, 12.0, 0.012, "m");
    findings.atMost(must, "no rolling friction: turns back", result.reversal.maxCoeff(), 1e-10,
                    "rad/s");
    result.speeds.name = "measured, none";
    plot.curves.push_back(result.speeds);
    if (context.method != "paper") return;
    ShotRun material(context, "E09_rolling", withResistance(0.0),
                     [](StepSettings& settings) { settings.slideSmoothSamples = false; });
    Roll dragged = roll(material, 6.0);
    findings.atMost(control, "rolling on material points (A40 left out): speed after 6 s",
                    dragged.speed, 1.6, "m/s", "theory of the flaw: a factor exp(-0.35)");
    dragged.speeds.name = "control: none, without A40";
    plot.curves.push_back(dragged.speeds);
}

/// After two seconds on the slope.
struct Descent {
    double distance = 0.0, acceleration = 0.0, spinRate = 0.0;
};

Descent descend(const Context& context, double friction)
{
    ShotRun run(context, "E09_incline", {setNumber("material.slope.friction", friction)});
    run.advance(2.0, 240.0);
    const Vec3 downhill(std::sqrt(0.75), -0.5, 0.0);
    const BodyId ball = run.body("ball");
    const Vec3 moved = run.world.motion[ball].position - run.start.motion[ball].position;
    return {moved.dot(downhill), run.world.motion[ball].velocity.dot(downhill) / 2.0,
            -spinOf(run.world, ball).z() / 2.0};
}

void downTheSlope(const Context& context, Findings& findings)
{
    const Descent rolls = descend(context, 1.0);
    findings.near(must, "E9b, slope of 30 degrees: distance in 2 s", rolls.distance, 7.0,
                  0.005 * 7.0, "m", "five sevenths of g sin 30");
    findings.near(must, "E9b: acceleration", rolls.acceleration, 3.5, 0.005 * 3.5, "m/s^2");
    const Descent slides = descend(context, 0.1);
    findings.near(must, "E9b, friction 0.1: acceleration", slides.acceleration, 4.0513,
                  0.005 * 4.0513, "m/s^2");
    findings.near(must, "E9b, friction 0.1: spins up", slides.spinRate, 4.2435, 0.005 * 4.2435,
                  "rad/s^2");
}

void meshedSphere(const Context& context, Findings& findings)
{
    const auto rollMesh = [&](double mu, double seconds) {
        std::vector<std::string> overrides = withResistance(mu);
        overrides.emplace_back("shape.ball.collide=\"mesh\"");
        ShotRun run(context, "E09_rolling", overrides);
        return roll(run, seconds);
    };
    findings.atLeast(must, "E9c, sphere of 1280 triangles, no rolling friction: speed after 6 s",
                     rollMesh(0.0, 6.0).speed, 1.9, "m/s");
    for (double mu : {0.05, 0.5}) {
        const Roll result = rollMesh(mu, mu < 0.5 ? 6.0 : 2.0);
        const double braking = 0.5 * mu * 2.0 * 9.8, stop = 2.0 / braking;
        // This one stops when it is too slow for the next edge: to lift it by R t²/8 = 1.2 mm,
        // t = 0.14 rad being the width of a facet, takes 0.13 m/s.
        const std::string name = "E9c, coefficient " + shortNumber(mu) + ": ";
        findings.near(must, name + "stops rolling", result.rollStop, stop, 0.13 / braking + kStep,
                      "s", "a facet may hold it earlier");
        findings.atMost(must, name + "turns back", larger(result.reversal.y(), result.reversal.z()),
                        1e-6, "rad/s");
        findings.atMost(context.method == "scree" ? must : departure,
                        name + "turns to and fro sideways", result.reversal.x(), 1e-10, "rad/s",
                        "where it had no spin: facets lead it off its line");
    }
}

void otherShapes(const Context& context, Findings& findings)
{
    ShotRun run(context, "E09_tumbling");
    double energy = mechanicalEnergy(run.world, run.shot.settings.gravity), rise = 0.0,
           reversal = 0.0;
    run.advance(4.0, 240.0, [&](const StepReport& report, double) {
        const double now = mechanicalEnergy(run.world, run.shot.settings.gravity);
        rise = larger(rise, now - energy - report.pushOutWork);
        energy = now;
        for (const char* name : {"cube", "egg"}) {
            reversal = larger(reversal, -spinOf(run.world, run.body(name)).y());
        }
    });
    findings.atMost(must, "E9d, cube and egg: energy rises in a step", rise, 1e-9, "J",
                    "work of push-out apart");
    findings.atMost(must, "E9d, cube and egg: spin about the normal turns back", reversal, 2e-3,
                    "rad/s", "a thousandth of what it had");
    findings.atMost(departure, "E9d, cube and egg: spin about the normal turns back, at all",
                    reversal, 1e-10, "rad/s",
                    "no impulse reverses the spin it brakes; corners that strike one after the "
                    "other turn a tumbling body");
    addPicture(context, run, "Cube and egg after 4 s", findings);
}

}  // namespace

void runRolling(const Context& context, Findings& findings)
{
    Plot plot{"Speed of a rolling ball, by coefficient of rolling friction",
              "time [s]",
              "speed [m/s]",
              {}};
    braked(context, findings, plot);
    unbraked(context, findings, plot);
    downTheSlope(context, findings);
    meshedSphere(context, findings);
    otherShapes(context, findings);
    findings.plots.push_back(plot);
}

}  // namespace scree::verify
