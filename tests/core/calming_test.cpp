// What rocks comes to rest by and by; what goes somewhere does not.
#include "core/dynamics/gaps/calming.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

/// The largest angular speed of a body in the last two seconds of `frames` [rad/s].
double speedAtTheEnd(World world, BodyId body, bool mayRest, int frames)
{
    StepSettings settings = screeSettings();
    settings.sleep = mayRest;
    Stepper stepper(settings);
    double fastest = 0.0;
    for (int f = 0; f < frames; ++f) {
        stepper.advanceFrame(world, kFrame);
        if (f >= frames - 48) fastest = std::max(fastest, angularVelocityOf(world, body).norm());
    }
    return fastest;
}

/// A plank balanced on a fixed ball, which is its second body, rocks for ever.
World plankOnABall(double spin)
{
    World world;
    const MaterialId material = addMaterial(world, 0.9, 0.0);
    addBody(world, exactSphere(0.5), material, {Vec3::Zero(), Quat::Identity()}, 0.0);
    addBody(world, boxShape({1.0, 0.1, 1.0}, 2), material, {Vec3(0.0, 0.55, 0.0), Quat::Identity()},
            1.0, Vec3::Zero(), Vec3(0.0, 0.0, spin));
    return world;
}

double rockingOfAPlank(bool mayRest, double spin)
{
    return speedAtTheEnd(plankOnABall(spin), 1, mayRest, 240);
}

TEST(Calming, WhatRocksInItsPlaceComesToRestTheWiderTheLaterAndWhatGoesFartherDoesNot)
{
    EXPECT_GE(rockingOfAPlank(false, 0.06), 0.02);
    EXPECT_EQ(rockingOfAPlank(true, 0.06), 0.0);
    EXPECT_GE(rockingOfAPlank(false, 1.0), 0.9);
    EXPECT_LE(rockingOfAPlank(true, 1.0), 0.6);
    EXPECT_GE(rockingOfAPlank(true, 3.0), 2.5);
}

// At the end of each frame it is where it turns back, and has no motion to be taken.
TEST(Calming, WhatRocksOnceInTwoFramesComesToRestToo)
{
    StepSettings settings = screeSettings();
    settings.sleep = false;
    World free = plankOnABall(0.06);
    Stepper watched(settings);
    int quarter = 0;  // of its period, in 240ths of a second
    while (angularVelocityOf(free, 1).z() > 0.0) {
        watched.advanceFrame(free, 1.0 / 240.0);
        ASSERT_LE(++quarter, 2400);
    }
    settings.sleep = true;
    World world = plankOnABall(0.06);
    Stepper stepper(settings);
    stepper.advanceFrame(world, quarter / 240.0);
    for (int f = 0; f < 40; ++f) stepper.advanceFrame(world, 2.0 * quarter / 240.0);
    double fastest = 0.0;
    stepper.advanceFrame(world, 2.0 * quarter / 240.0, {}, [&](const World& now, double) {
        fastest = std::max(fastest, angularVelocityOf(now, 1).norm());
    });
    EXPECT_EQ(fastest, 0.0);
}

/// Of a disc that rocks on a fixed ball and spins about its own axis, in the last two seconds of
/// ten: the largest angular speed across the axis and the smallest about it [rad/s].
std::pair<double, double> rockingOfADisc(bool mayRest)
{
    World world;
    const MaterialId material = addMaterial(world, 0.9, 0.0);
    addBody(world, exactSphere(0.5), material, {Vec3::Zero(), Quat::Identity()}, 0.0);
    const auto shape = buildMeshShape("disc", makeCylinder(0.5, 0.1, 48, 1));
    const BodyId disc = addBody(world, shape, material, {Vec3(0.0, 0.55, 0.0), Quat::Identity()},
                                1.0, Vec3::Zero(), Vec3(0.0, 2.0, 1.0));
    StepSettings settings = screeSettings();
    settings.sleep = mayRest;
    Stepper stepper(settings);
    double across = 0.0, about = 9.0;
    for (int f = 0; f < 240; ++f) {
        stepper.advanceFrame(world, kFrame);
        if (f < 192) continue;
        const Vec3 spin = angularVelocityOf(world, disc);
        const Vec3 shown = shape->shownOf(spin, world.motion[disc].orientation);
        across = std::max(across, shown.norm());
        about = std::min(about, (spin - shown).norm());
    }
    return {across, about};
}

TEST(Calming, WhatIsRoundRocksLessAndLessButSpinsOn)
{
    const auto [free, spinOfFree] = rockingOfADisc(false);
    const auto [calmed, spinOfCalmed] = rockingOfADisc(true);
    EXPECT_GE(free, 0.8);
    EXPECT_LE(calmed, 0.6 * free);
    EXPECT_GE(spinOfFree, 1.7);
    EXPECT_GE(spinOfCalmed, 1.7);
}

/// A ring of 2.5 m hangs over a fixed pole and swings.
double swingOfARing(bool mayRest)
{
    World world;
    const MaterialId material = addMaterial(world, 0.9, 0.0);
    const Quat upright = fromEulerXyz({0.5 * kPi, 0.0, 0.0});
    addBody(world, exactCylinder(0.2, 2.0), material, {Vec3::Zero(), upright}, 0.0);
    const BodyId ring =
        addBody(world, buildMeshShape("ring", makeTorus(1.0, 0.25, {48, 12})), material,
                {Vec3(0.0, -0.55, 0.0), upright}, 1.0, Vec3(0.2, 0.0, 0.0), Vec3(0.0, 0.0, 0.3));
    return speedAtTheEnd(world, ring, mayRest, 384);
}

TEST(Calming, WhatHangsSwingsOn)
{
    const double free = swingOfARing(false);
    EXPECT_GE(free, 0.05);
    EXPECT_GE(swingOfARing(true), 0.8 * free);
}

// Taken for something that rocks in its place, it was held at a few millimetres a second.
TEST(Calming, WhatSlidesOnASlopeBarelySteeperThanFrictionHoldsGoesOnFasterAndFaster)
{
    constexpr double kSlope = 20.0 * kPi / 180.0;
    for (const double acceleration : {0.005, 0.01, 0.03}) {
        World world;
        const StepSettings settings = screeSettings();
        const double g = settings.gravity.norm();
        const MaterialId material =
            addMaterial(world, std::tan(kSlope) - acceleration / (g * std::cos(kSlope)), 0.0);
        const Vec3 normal(std::sin(kSlope), std::cos(kSlope), 0.0);
        addPlane(world, material, Vec3::Zero(), normal);
        const BodyId block = addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                                     {0.25 * normal, fromEulerXyz({0.0, 0.0, -kSlope})});
        const Vec3 start = world.motion[block].position;
        Stepper stepper(settings);
        for (int f = 0; f < 240; ++f) stepper.advanceFrame(world, kFrame);
        const double way = 0.5 * acceleration * 100.0;
        EXPECT_NEAR((world.motion[block].position - start).norm(), way, 0.02 * way) << acceleration;
    }
}

}  // namespace
}  // namespace scree::test
