// E13, E14: motion without contact.  [A18, A19]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

Vec3 draw(std::uint64_t body, std::uint64_t what, double size)
{
    const auto unit = [&](std::uint64_t axis) {
        return size * (2.0 * randomUnit(13, body, what, axis) - 1.0);
    };
    return {unit(0), unit(1), unit(2)};
}

TEST(E13FreeFlight, AHundredSpinningBodiesKeepEveryLawForTenSeconds)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.5);
    for (std::uint64_t b = 0; b < 100; ++b) {
        const Vec3 place(20.0 * static_cast<double>(b % 10), 0.0,
                         20.0 * static_cast<double>(b / 10));
        addBody(world, boxShape({0.2, 0.4, 0.8}, 1), material,
                {place, exponentialMap(draw(b, 0, 3.0))}, 1.0, 0.1 * draw(b, 1, 1.0),
                draw(b, 2, 5.0));
    }
    const World start = world;
    const StepSettings settings = experimentSettings();
    Stepper stepper(settings);
    const double dt = 1.0 / 240.0;
    const int steps = 2400;
    std::int64_t impulses = 0;
    for (int k = 0; k < steps; ++k) {
        const StepReport report = stepper.step(world, dt);
        impulses += report.collisionImpulses.total() + report.contactImpulses.total() +
                    report.shockImpulses.total() + report.pushes;
    }
    EXPECT_EQ(impulses, 0);
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const BodyMotion &before = start.motion[b], &after = world.motion[b];
        // Positions use the new velocities: the sum of k dt over k = 1 … n, not the integral.
        const double n = steps;
        const Vec3 expected = before.position + n * dt * before.velocity +
                              0.5 * n * (n + 1.0) * dt * dt * settings.gravity;
        EXPECT_LE((after.position - expected).norm(), 1e-12 * expected.norm()) << "body " << b;
        EXPECT_LE((after.angularMomentum - before.angularMomentum).norm(),
                  1e-13 * before.angularMomentum.norm());
        EXPECT_NEAR(after.orientation.norm(), 1.0, 1e-14);
    }
}

/// Angle between the orientations reached by steps of dt and by much finer ones.
double orientationError(double stepsPerSecond)
{
    const auto fly = [](double rate) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.5);
        addBody(world, boxShape({0.2, 0.4, 0.8}, 1), material, {}, 1.0, Vec3::Zero(),
                {1.0, 3.0, -2.0});
        for (int k = 0; k < rate; ++k) advancePositions(world, experimentSettings(), 1.0 / rate);
        return world.motion[0].orientation;
    };
    return 2.0 * (fly(25600.0).conjugate() * fly(stepsPerSecond)).vec().norm();
}

TEST(E13FreeFlight, OrientationIsOfSecondOrderInTheStep)
{
    EXPECT_NEAR(orientationError(100.0) / orientationError(200.0), 4.0, 0.3);
}

struct Tumble {
    double energyChange = 0.0, momentumChange = 0.0;
    std::vector<double> flips;  // times at which the body's middle spin changes sign [s]
};

/// The 0.2 × 0.4 × 0.8 m box of 1 kg, almost spinning about its middle axis, for 20 s.
Tumble tumble(double rate, OrientationUpdate update)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.5);
    addBody(world, boxShape({0.2, 0.4, 0.8}, 1), material, {}, 1.0, Vec3::Zero(), {0.05, 5.0, 0.0});
    StepSettings settings = experimentSettings();
    settings.orientation = update;
    const Vec3 momentum = world.motion[0].angularMomentum;
    const double energy = kineticEnergy(world.motion[0], world.mass[0]);
    Tumble result;
    const auto middleSpin = [&] {
        return (world.worldFromAsset(0).orientation.conjugate() * angularVelocityOf(world, 0)).y();
    };
    double before = middleSpin();
    for (int k = 1; k <= 20.0 * rate; ++k) {
        advancePositions(world, settings, 1.0 / rate);
        const double after = middleSpin();
        if (before * after < 0.0) result.flips.push_back((k - after / (after - before)) / rate);
        before = after;
    }
    result.energyChange = kineticEnergy(world.motion[0], world.mass[0]) / energy - 1.0;
    result.momentumChange = (world.motion[0].angularMomentum - momentum).norm();
    return result;
}

TEST(E14Tumbling, TheSecondOrderUpdateKeepsEnergyAndTheTimesOfTheFlips)
{
    const Tumble coarse = tumble(60.0, OrientationUpdate::secondOrder);
    const Tumble usual = tumble(240.0, OrientationUpdate::secondOrder);
    const Tumble fine = tumble(960.0, OrientationUpdate::secondOrder);
    EXPECT_LE(std::abs(coarse.energyChange), 5e-3);
    EXPECT_LE(std::abs(usual.energyChange), 1e-4);
    EXPECT_LE(usual.momentumChange, 1e-13);
    ASSERT_EQ(usual.flips.size(), 5u);
    ASSERT_EQ(fine.flips.size(), 5u);
    // Times of a Runge–Kutta reference with a step of 1e-4 s.
    EXPECT_NEAR(usual.flips[3], 13.5298, 0.02 * 13.5298);
    EXPECT_NEAR(fine.flips[3], 13.5298, 0.001 * 13.5298);
}

TEST(E14Tumbling, ForwardEulerMoreThanDoublesTheEnergy)
{
    EXPECT_GT(tumble(240.0, OrientationUpdate::euler).energyChange, 1.0);
}

}  // namespace
}  // namespace scree::test
