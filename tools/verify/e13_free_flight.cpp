// E13, E14: motion without contact. [A18, A19]  Inputs are built in code: a hundred random spins
// and a box whose orientation update is looked at alone.
#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/integrator.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

Vec3 draw(std::uint64_t body, std::uint64_t what, double size)
{
    const auto unit = [&](std::uint64_t axis) {
        return size * (2.0 * randomUnit(13, body, what, axis) - 1.0);
    };
    return {unit(0), unit(1), unit(2)};
}

StepSettings settingsOf(const Context& context)
{
    StepSettings settings;
    settings.method = methodOf(context);
    settings.gravity = {0.0, -9.8, 0.0};
    return settings;
}

/// Boxes of 0.2 × 0.4 × 0.8 m and 1 kg, far from each other, each added by `place`.
World boxes(int count, const std::function<void(std::uint64_t, BodyDefinition&)>& place)
{
    static const auto box = buildMeshShape("box", makeBox({0.2, 0.4, 0.8}, {1, 1, 1}));
    World world;
    const ShapeId shape = world.addShape(box);
    world.addMaterial({"material", 1.0, 0.5, 0.5});
    for (int b = 0; b < count; ++b) {
        BodyDefinition definition;
        definition.name = "box_" + std::to_string(b);
        definition.shape = shape;
        definition.mass = 1.0;
        place(static_cast<std::uint64_t>(b), definition);
        world.addBody(definition);
    }
    return world;
}

World spinningBox(const Vec3& spin)
{
    return boxes(1, [&](std::uint64_t, BodyDefinition& box) { box.angularVelocity = spin; });
}

/// Angle between the orientations reached by steps of dt and by much finer ones.
double orientationError(const Context& context, double stepsPerSecond)
{
    const auto fly = [&](double rate) {
        World world = spinningBox({1.0, 3.0, -2.0});
        Stepper stepper(settingsOf(context));
        for (int k = 0; k < rate; ++k) stepper.step(world, 1.0 / rate);
        return world.motion[0].orientation;
    };
    return chordOfTurn(fly(25600.0), fly(stepsPerSecond));
}

struct Tumble {
    double energyChange = 0.0;         // at the end, relative
    double largestEnergyChange = 0.0;  // at any time, either way
    double momentumChange = 0.0;       // at the end
    std::vector<double> flips;         // times at which the body's middle spin changes sign [s]
    Curve spin;                        // about the middle axis
};

/// The box, almost spinning about its middle axis, for 20 s.
Tumble tumble(const Context& context, double rate, OrientationUpdate update)
{
    World world = spinningBox({0.05, 5.0, 0.0});
    StepSettings settings = settingsOf(context);
    settings.gravity = Vec3::Zero();
    settings.orientation = update;
    Stepper stepper(settings);
    const Vec3 momentum = world.motion[0].angularMomentum;
    const double energy = kineticEnergy(world.motion[0], world.mass[0]);
    const auto middleSpin = [&] {
        return (world.worldFromAsset(0).orientation.conjugate() * spinOf(world, 0)).y();
    };
    Tumble result;
    double before = middleSpin();
    for (int k = 1; k <= 20.0 * rate; ++k) {
        stepper.step(world, 1.0 / rate);
        const double change = kineticEnergy(world.motion[0], world.mass[0]) / energy - 1.0;
        result.energyChange = change;
        result.largestEnergyChange = larger(result.largestEnergyChange, std::abs(change));
        const double after = middleSpin();
        if (before * after < 0.0) result.flips.push_back((k - after / (after - before)) / rate);
        before = after;
        result.spin.x.push_back(k / rate);
        result.spin.y.push_back(after);
    }
    result.momentumChange = (world.motion[0].angularMomentum - momentum).norm();
    return result;
}

/// How far from its parabola a box is after a second of free fall from 2 m/s upward [m].
double fallError(const Context& context, double stepsPerSecond)
{
    World world = boxes(1, [](std::uint64_t, BodyDefinition& box) {
        box.velocity = {0.0, 2.0, 0.0};
    });
    Stepper stepper(settingsOf(context));
    for (int k = 0; k < stepsPerSecond; ++k) stepper.step(world, 1.0 / stepsPerSecond);
    return std::abs(world.motion[0].position.y() - (2.0 - 0.5 * 9.8));
}

}  // namespace

void runFreeFlight(const Context& context, Findings& findings)
{
    const bool isPaper = context.method == "paper";
    World world = boxes(100, [](std::uint64_t b, BodyDefinition& box) {
        box.worldFromAsset = {
            Vec3(20.0 * static_cast<double>(b % 10), 0.0, 20.0 * static_cast<double>(b / 10)),
            exponentialMap(draw(b, 0, 3.0))};
        box.velocity = 0.1 * draw(b, 1, 1.0);
        box.angularVelocity = draw(b, 2, 5.0);
    });
    const World start = world;
    const StepSettings settings = settingsOf(context);
    Stepper stepper(settings);
    const double dt = 1.0 / 240.0, n = 2400.0;
    std::int64_t impulses = 0;
    double position = 0.0, momentum = 0.0, unit = 0.0;
    for (int k = 1; k <= n; ++k) {
        const StepReport report = stepper.step(world, dt);
        impulses += report.collisionImpulses.total() + report.contactImpulses.total() +
                    report.shockImpulses.total() + report.pushes;
        for (std::size_t b = 0; b < world.bodyCount(); ++b) {
            const Vec3 &before = start.motion[b].angularMomentum,
                       &after = world.motion[b].angularMomentum;
            momentum = larger(momentum, (after - before).norm() / before.norm());
            unit = larger(unit, std::abs(world.motion[b].orientation.norm() - 1.0));
        }
    }
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const BodyMotion &before = start.motion[b], &after = world.motion[b];
        // The paper's positions use the new velocities: the sum of k dt over k = 1 … n. Method
        // scree's are the integral.
        const double squares = isPaper ? n * (n + 1.0) : n * n;
        const Vec3 expected =
            before.position + n * dt * before.velocity + 0.5 * squares * dt * dt * settings.gravity;
        position = larger(position, (after.position - expected).norm() / expected.norm());
    }
    findings.atMost(must, "a hundred bodies, 10 s: position against the method's own sum", position,
                    1e-12, "relative");
    findings.atMost(must, "angular momentum changes in any step", momentum, 1e-13, "relative");
    findings.atMost(must, "length of the quaternion is off one in any step", unit, 1e-14, "-");
    findings.equal(must, "impulses", static_cast<double>(impulses), 0);
    if (isPaper) {
        findings.near(must, "position: error at dt over error at dt/2",
                      fallError(context, 100.0) / fallError(context, 200.0), 2.0, 0.1, "-",
                      "first order in dt");
    } else {
        findings.atMost(must, "position: error at one step a frame", fallError(context, 24.0),
                        1e-12, "m", "no order in dt: it is the parabola");
    }
    findings.near(must, "orientation: error at dt over error at dt/2",
                  orientationError(context, 100.0) / orientationError(context, 200.0), 4.0, 0.3,
                  "-", "second order in dt");
}

void runTumbling(const Context& context, Findings& findings)
{
    const Tumble coarse = tumble(context, 60.0, OrientationUpdate::secondOrder);
    const Tumble usual = tumble(context, 240.0, OrientationUpdate::secondOrder);
    const Tumble fine = tumble(context, 960.0, OrientationUpdate::secondOrder);
    const auto fourthFlip = [](const Tumble& run) {
        return run.flips.size() < 4 ? std::nan("") : run.flips[3];
    };
    findings.atMost(must, "energy changes at any time, 60 Hz", coarse.largestEnergyChange, 5e-3,
                    "relative");
    findings.atMost(must, "energy changes at any time, 240 Hz", usual.largestEnergyChange, 1e-4,
                    "relative");
    findings.atMost(must, "angular momentum changes", usual.momentumChange, 1e-13, "kg m^2/s");
    findings.equal(must, "flips within 20 s", static_cast<double>(usual.flips.size()), 5);
    // Against a Runge–Kutta reference with a step of 1e-4 s. Errors of the phase add up: where the
    // fourth flip may be 2 % late, those before it are later by less.
    const double reference[] = {1.9329, 5.7985, 9.6641};
    double late = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double flip = i < usual.flips.size() ? usual.flips[i] : std::nan("");
        late = larger(late, std::abs(flip / reference[i] - 1.0));
    }
    findings.atMost(must, "times of the first three flips, 240 Hz: off by", late, 0.02, "of them");
    findings.near(must, "time of the fourth flip, 240 Hz", fourthFlip(usual), 13.5298,
                  0.02 * 13.5298, "s");
    findings.near(must, "time of the fourth flip, 960 Hz", fourthFlip(fine), 13.5298,
                  0.001 * 13.5298, "s");
    const Tumble byDefault = tumble(context, 24.0, settingsOf(context).orientation);
    findings.atMost(must, "energy changes by default, at one step a frame",
                    byDefault.largestEnergyChange, 1e-3, "relative");
    findings.near(must, "time of the fourth flip by default, at one step a frame",
                  fourthFlip(byDefault), 13.5298, 0.002 * 13.5298, "s");
    const Tumble secondOrder = tumble(context, 24.0, OrientationUpdate::secondOrder);
    findings.atLeast(control, "second order at one step a frame: energy gained",
                     secondOrder.energyChange, 0.01, "relative");
    Tumble euler = tumble(context, 240.0, OrientationUpdate::euler);
    findings.atLeast(control, "forward Euler, the paper's: energy gained", euler.energyChange, 1.0,
                     "relative");
    const Tumble fineEuler = tumble(context, 960.0, OrientationUpdate::euler);
    findings.report("forward Euler at 960 Hz: energy gained", fineEuler.energyChange, "relative",
                    "the paper's update: 12 % expected");
    Curve spin = usual.spin;
    spin.name = "second order, 240 Hz";
    euler.spin.name = "control: forward Euler, 240 Hz";
    findings.plots.push_back({"Spin about the middle axis of a tumbling box",
                              "time [s]",
                              "spin [rad/s]",
                              {spin, euler.spin}});
}

}  // namespace scree::verify
