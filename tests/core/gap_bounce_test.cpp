// Impacts of method `scree`: blows that come at once and blows that follow from each other.
// Experiments E3, E15 and E16 have more of them.  [A22–A28]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/draw.h"
#include "tests/support/momenta.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kStep = 1.0 / 240.0;

StepSettings weightless()
{
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    return settings;
}

/// Balls of radius 0.5 m and 1 kg on the x axis.
World makeBalls(double restitution, const std::vector<double>& places,
                const std::vector<double>& speeds)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, restitution);
    for (std::size_t i = 0; i < places.size(); ++i) {
        addBody(world, exactSphere(0.5), material, {places[i] * Vec3::UnitX(), Quat::Identity()},
                1.0, speeds[i] * Vec3::UnitX());
    }
    return world;
}

std::vector<double> speedsAfter(World world, int steps)
{
    Stepper stepper(weightless());
    for (int i = 0; i < steps; ++i) stepper.step(world, kStep);
    std::vector<double> speeds;
    for (const BodyMotion& motion : world.motion) speeds.push_back(motion.velocity.x());
    return speeds;
}

TEST(GapBounce, WhatIsHitFromTwoSidesAtOnceFavoursNeitherWhicheverIsListedFirst)
{
    const std::array<std::array<int, 3>, 3> orders = {{{0, 1, 2}, {1, 0, 2}, {2, 0, 1}}};
    const std::array<double, 3> places = {-1.1, 0.0, 1.1}, speeds = {2.0, 0.0, -2.0};
    for (const auto& order : orders) {
        std::vector<double> placed, driven;
        for (const int i : order) {
            placed.push_back(places[i]);
            driven.push_back(speeds[i]);
        }
        const std::vector<double> after = speedsAfter(makeBalls(0.8, placed, driven), 20);
        // The sweeps over the two end at 1e-4 of the speed. One after the other they left at 1.438
        // and 1.42 m/s, and the middle one went along.
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(after[k], -0.8 * driven[k], 1e-3);
    }
}

TEST(GapBounce, BlowsThatFollowFromEachOtherRunAlongARowWithinAStep)
{
    // Two run into three that touch, in the ninth step: two leave.
    const World world = makeBalls(1.0, {-1.5, -0.5, 0.61, 1.61, 2.61}, {3.0, 3.0, 0.0, 0.0, 0.0});
    EXPECT_EQ(speedsAfter(world, 8), (std::vector<double>{3.0, 3.0, 0.0, 0.0, 0.0}));
    const std::vector<double> after = speedsAfter(world, 9);
    const std::array<double, 5> expected = {0.0, 0.0, 0.0, 3.0, 3.0};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(after[k], expected[k], 1e-9) << k;
}

struct TableBall {
    double x;       // [m]
    Vec3 velocity;  // [m/s]
};

/// Velocities after one step of elastic balls of 0.2 m on a table of a thousand rows, which two
/// threads share; the cut between their halves goes through x = 0. Far away there is enough to do
/// to make sharing worth while.
std::vector<Vec3> velocitiesOnASharedTable(const std::vector<TableBall>& balls)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    for (int i = 0; i < 16 * 10; ++i)
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {Vec3(i % 16 - 7.5, -0.5, i / 16 - 4.5), Quat::Identity()}, 1000.0);
    const auto first = static_cast<BodyId>(world.bodyCount());
    const auto addBall = [&](const Vec3& place, const Vec3& velocity) {
        addBody(world, exactSphere(0.2), material, {place, Quat::Identity()}, 1.0, velocity);
    };
    for (const TableBall& ball : balls) addBall(Vec3(ball.x, 0.2, 0.5), ball.velocity);
    for (int i = 0; i < 40; ++i) {
        addBall(Vec3(-0.21, 10.0 + i, 0.0), 10.0 * Vec3::UnitX());
        addBall(Vec3(0.21, 10.0 + i, 0.0), -10.0 * Vec3::UnitX());
    }
    Stepper stepper(weightless());
    EXPECT_GT(stepper.step(world, kStep).contacts, 1000);
    std::vector<Vec3> velocities;
    for (std::size_t k = 0; k < balls.size(); ++k)
        velocities.push_back(world.motion[first + static_cast<BodyId>(k)].velocity);
    return velocities;
}

TEST(GapBounce, WhatIsHitFromTwoSidesFavoursNeitherWhereThreadsShareTheWork)
{
    // Not hit at first: each through another ball.
    const Vec3 fast = 10.0 * Vec3::UnitX(), still = Vec3::Zero();
    const std::vector<Vec3> after = velocitiesOnASharedTable(
        {{-0.806, fast}, {-0.403, still}, {0.0, still}, {0.403, still}, {0.806, -fast}});
    const std::array<Vec3, 5> expected = {-fast, still, still, still, fast};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR((after[k] - expected[k]).norm(), 0.0, 1e-3);
}

TEST(GapBounce, ABlowIsPassedOnWhereThreadsShareTheWork)
{
    const Vec3 fast = 10.0 * Vec3::UnitX(), still = Vec3::Zero();
    // In one half, beside a ball of the other that is not reached.
    const std::vector<Vec3> within =
        velocitiesOnASharedTable({{-0.44, still}, {0.0, still}, {0.403, still}, {0.806, -fast}});
    const std::array<Vec3, 4> passedOn = {still, -fast, still, still};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR((within[k] - passedOn[k]).norm(), 0.0, 1e-3);
    // From one half to the other, where the pair that is hit last had been done with.
    const Vec3 away = 0.2 * Vec3::UnitX();
    const std::vector<Vec3> across = velocitiesOnASharedTable(
        {{-0.806, fast}, {-0.403, still}, {0.0, still}, {0.403, still}, {0.8035, -away}});
    const std::array<Vec3, 5> handed = {still, still, -away, still, fast};
    for (std::size_t k = 0; k < 5; ++k)
        EXPECT_NEAR((across[k] - handed[k]).norm(), 0.0, 1e-3) << across[k].transpose();
}

TEST(GapBounce, FrictionTurnsABallByItsRadiusHoweverFarItFellInTheStep)
{
    constexpr double kRadius = 0.5;
    for (const double start : {0.7, 0.8, 0.9, 1.0, 1.1}) {
        World world;
        const MaterialId material = addMaterial(world, 0.2, 0.5);
        addPlane(world, material);
        const Vec3 before(20.0, -20.0, 0.0);
        const BodyId ball = addBody(world, exactSphere(kRadius), material,
                                    {{0.0, start, 0.0}, Quat::Identity()}, 1.0, before);
        Stepper stepper(weightless());
        for (int frame = 0; frame < 2; ++frame) stepper.advanceFrame(world, 1.0 / 24.0);
        const Vec3 change = world.motion[ball].velocity - before;
        ASSERT_LT(change.x(), -1.0);
        // Of a kilogramme: what it has got of angular momentum by so much of momentum.
        const double lever = world.motion[ball].angularMomentum.z() / change.x();
        EXPECT_NEAR(std::abs(lever), kRadius, 1e-6) << start;
    }
}

/// The least and the most energy that a body has that tumbles over the ground, elastic and without
/// friction, as a share of what it had at first.
std::pair<double, double> energyOfTumbling(const std::shared_ptr<const Shape>& shape, double spin)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    addPlane(world, material);
    addBody(world, shape, material, {{0.0, 2.0, 0.0}, fromEulerXyz({0.35, 0.52, 0.7})}, 1.0,
            {1.0, 0.0, 0.3}, spin * Vec3(1.0, 0.3, -0.5));
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    const auto energyOf = [](const FrameReport& report) {
        return report.kineticEnergy + report.potentialEnergy;
    };
    const double before = energyOf(reportStart(world, settings.gravity));
    double least = 1.0, most = 1.0;
    for (int frame = 0; frame < 240; ++frame) {
        const double share = energyOf(stepper.advanceFrame(world, 1.0 / 24.0)) / before;
        least = std::min(least, share);
        most = std::max(most, share);
    }
    return {least, most};
}

TEST(GapBounce, WhatLandsOnPlacesBesideEachOtherGainsNoEnergyToSpeakOf)
{
    const auto ring = buildMeshShape("ring", makeTorus(0.25, 0.08, {24, 12}));
    for (const double spin : {0.0, 0.75, 3.75, 8.25, 9.75})
        EXPECT_LE(energyOfTumbling(ring, spin).second, 1.002) << spin;
}

TEST(GapBounce, WhatTumblesKeepsItsEnergy)
{
    const auto slab = boxShape({0.6, 0.4, 0.1}, 1);
    for (const double spin : {0.0, 1.0, 4.0, 7.0, 10.0}) {
        const auto [least, most] = energyOfTumbling(slab, spin);
        EXPECT_GE(least, 0.985) << spin;
        EXPECT_LE(most, 1.015) << spin;
    }
}

/// A rod of 1 kg that turns in a vertical plane and flies down on the ground, without gravity.
struct FlyingRod {
    Vec3 size;
    double height, angle, fall, turning,
        sideways;  // of its centre [m], [rad], [m/s], [rad/s], [m/s]

    World aboveGround(double restitution, double friction) const
    {
        World world;
        const MaterialId material = addMaterial(world, friction, restitution);
        addPlane(world, material);
        addBody(world, boxShape(size, 1), material,
                {{0.0, height, 0.0}, fromEulerXyz({0.0, 0.0, angle})}, 1.0, {sideways, -fall, 0.0},
                {0.0, 0.0, turning});
        return world;
    }

    /// The height of its lowest place at a time, and where that is from its centre.
    double lowest(double t, Vec3& arm) const
    {
        double least = height;
        for (const double x : {-0.5, 0.5}) {
            for (const double y : {-0.5, 0.5}) {
                const Vec3 place = fromEulerXyz({0.0, 0.0, angle + turning * t}) *
                                   Vec3(x * size.x(), y * size.y(), 0.0);
                if (place.y() >= least) continue;
                least = place.y();
                arm = place;
            }
        }
        return height - fall * t + least;
    }
};

/// Velocity and spin of a rod when it has landed on one end, by Newton's rule.
struct EndOfRod {
    Vec3 velocity;
    double spin;
    FrictionCase friction;

    EndOfRod(const FlyingRod& rod, double restitution, double mu)
    {
        double before = 0.0, after = rod.height / rod.fall;
        Vec3 arm = Vec3::Zero();
        for (int n = 0; n < 1000; ++n) {  // the first time, well before which nothing touches
            const double t = after * n / 1000;
            if (rod.lowest(t, arm) <= 0.0) {
                after = t;
                break;
            }
            before = t;
        }
        for (int n = 0; n < 60; ++n) {
            const double t = 0.5 * (before + after);
            (rod.lowest(t, arm) > 0.0 ? before : after) = t;
        }
        const Vec3 squares = rod.size.cwiseAbs2();
        const double inverseInertia = 12.0 / (squares.x() + squares.y());
        const Vec3 flight(rod.sideways, -rod.fall, 0.0), spinAxis(0.0, 0.0, 1.0);
        const Vec3 turned = spinAxis.cross(arm);
        const Mat3 response = Mat3::Identity() + inverseInertia * turned * turned.transpose();
        const ContactImpulse hit =
            contactImpulse(response, flight + rod.turning * turned, Vec3::UnitY(), restitution, mu);
        velocity = flight + hit.impulse;
        spin = rod.turning + inverseInertia * turned.dot(hit.impulse);
        friction = hit.kind;
    }
};

TEST(GapBounce, WhatLandsOnACornerAsItTurnsIsStruckWhereThisIsThen)
{
    for (const double restitution : {0.0, 0.5}) {
        for (const double turning : {-4.0, 2.0, 4.0}) {
            for (int n = 0; n < 12; ++n) {
                const FlyingRod rod{{1.0, 0.2, 0.3}, 1.0 + 0.03 * n, 0.5 * n, 3.0, turning, 0.0};
                World world = rod.aboveGround(restitution, 0.0);
                Stepper stepper(weightless());
                while (world.motion[1].velocity.y() <= -rod.fall) stepper.step(world, 1.0 / 96.0);
                const EndOfRod landed(rod, restitution, 0.0);
                EXPECT_NEAR(world.motion[1].velocity.y(), landed.velocity.y(), 2e-3)
                    << turning << " " << n;
                EXPECT_NEAR(angularVelocityOf(world, 1).z(), landed.spin, 5e-3)
                    << turning << " " << n;
            }
        }
    }
}

TEST(GapBounce, OfFrictionThatWouldAddEnergyAtSeveralPlacesAsMuchIsLeftAsAtOne)
{
    // Two corners land at once, and stand for the edge between them. Without any friction these
    // would keep all of their sideways speed.
    int fallbacks = 0;
    for (const double restitution : {0.8, 1.0}) {
        for (const double mu : {0.3, 1.0}) {
            for (const double turning : {-4.0, 2.0, 4.0}) {
                for (int n = 0; n < 12; ++n) {
                    const FlyingRod rod{
                        {1.0, 0.2, 0.3}, 1.0 + 0.03 * n, 0.5 * n, 3.0, turning, 1.0};
                    const EndOfRod landed(rod, restitution, mu);
                    if (landed.friction != FrictionCase::fallback) continue;
                    ++fallbacks;
                    World world = rod.aboveGround(restitution, mu);
                    Stepper stepper(weightless());
                    const BodyMotion& motion = world.motion[1];
                    while (motion.velocity.y() <= -rod.fall) stepper.step(world, 1.0 / 960.0);
                    EXPECT_LT((motion.velocity - landed.velocity).norm(), 5e-3)
                        << turning << " " << n;
                    EXPECT_NEAR(angularVelocityOf(world, 1).z(), landed.spin, 1e-2)
                        << turning << " " << n;
                }
            }
        }
    }
    EXPECT_GE(fallbacks, 20);
}

TEST(GapBounce, ABodyThatIsStruckLateInAStepDoesNotRunThroughWhatItMeetsBefore)
{
    // The first ball meets the heavy third after a sixth of the step and leaves it again. If the
    // second, which would strike it near the end, came first, it would be in the third by then.
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    const Vec3 aside(0.5, -std::sqrt(0.75), 0.0);
    addBody(world, exactSphere(0.5), material, Pose{}, 1.0, {3.0, 0.0, 0.0});
    addBody(world, exactSphere(0.5), material, {1.08 * aside, Quat::Identity()}, 1.0,
            -20.0 * aside);
    addBody(world, exactSphere(0.5), material, {Vec3(1.002, 0.0, 0.0), Quat::Identity()}, 1e9);
    Stepper stepper(weightless());
    stepper.step(world, kStep);
    EXPECT_NEAR(world.motion[0].velocity.x(), -3.0, 1e-6);
    EXPECT_GE((world.motion[2].position - world.motion[0].position).norm(), 1.0);
}

TEST(GapBounce, WhatIsStoppedLateInAStepDoesNotRunThroughWhatWasStoppedBefore)
{
    // Two blocks that touch fly into something heavy: the first at once, which goes on slowly, the
    // second by its corners near the end of the step. Nothing closes between the two then.
    constexpr double kSpeed = 3.0, kSlow = 0.01, kHeavy = 1e9;
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    const auto add = [&](const Vec3& size, const Vec3& centre, double mass, double speed) {
        return addBody(world, exactBox(size, 1), material, {centre, Quat::Identity()}, mass,
                       speed * Vec3::UnitX());
    };
    const BodyId second = add({1.0, 1.0, 1.0}, Vec3::Zero(), 1.0, kSpeed);
    const BodyId first = add({1.0, 0.3, 0.5}, {1.0, 0.0, 0.0}, 1.0, kSpeed);
    add({1.0, 0.3, 0.5}, {2.0, 0.0, 0.0}, kHeavy, kSlow);
    const double later = 0.9 * kSpeed * kStep;
    for (const double side : {-1.0, 1.0})
        add({1.0, 0.2, 1.5}, {1.0 + later, 0.4 * side, 0.0}, kHeavy, 0.0);
    Stepper(weightless()).step(world, kStep);
    EXPECT_NEAR(world.motion[first].position.x(), 1.0 + kSlow * kStep, 1e-6);
    EXPECT_LE(world.motion[second].position.x(), 1e-3);
    EXPECT_NEAR(world.motion[second].velocity.x(), 0.0, 1e-3 * kSpeed);
}

/// A ball of eighty triangles, battered by up to 15 % and flattened.
std::shared_ptr<const Shape> stoneShape(std::uint64_t seed)
{
    TriMesh mesh = makeSphere(0.25, 1);
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        mesh.points.col(v) *= 1.0 + 0.15 * signedUnit(seed, static_cast<std::uint64_t>(v));
        mesh.points(1, v) *= 0.7;
    }
    return buildMeshShape("stone", mesh);
}

TEST(GapBounce, AStoneThatRollsDoesNotSinkWhileItsNextCornerComesDown)
{
    for (std::uint64_t stone = 0; stone < 12; ++stone) {
        const auto shape = stoneShape(77 + stone);
        for (std::uint64_t n = 0; n < 100; ++n) {
            World world;
            const MaterialId material = addMaterial(world, 0.45, 0.1);
            addPlane(world, material);
            addBody(world, shape, material,
                    {Vec3(0.0, 0.6, 0.0), exponentialMap(3.0 * signedUnits(n, 0))}, 1.0,
                    {2.0 + 4.0 * randomUnit(7, n, 9), 0.0, 0.0}, 5.0 * signedUnits(n, 3));
            Stepper stepper(screeSettings());
            double deepest = 0.0;
            for (int i = 0; i < 96; ++i)
                deepest = std::max(deepest, stepper.step(world, 1.0 / 96.0).worstOverlapRatio);
            EXPECT_LT(deepest, 4e-3) << stone << ", " << n;
        }
    }
}

/// A ball that falls `drop` and keeps all its speed: the heights of its lowest point after each
/// step [m].
std::vector<double> heightsOfABounce(double drop, double rate, double seconds,
                                     double& mostEnergyHeight)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    addPlane(world, material);
    addBody(world, exactSphere(0.5), material, {Vec3(0.0, 0.5 + drop, 0.0), Quat::Identity()});
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    std::vector<double> heights;
    for (int i = 0; i < seconds * rate; ++i) {
        stepper.step(world, 1.0 / rate);
        heights.push_back(world.motion[1].position.y() - 0.5);
        const double speed = world.motion[1].velocity.y();
        mostEnergyHeight =
            std::max(mostEnergyHeight, heights.back() - 0.5 * speed * speed / settings.gravity.y());
    }
    return heights;
}

TEST(GapBounce, ABallNeverRisesAboveWhereItFellFromThoughItsStepsMissTheTopByTurns)
{
    for (const double rate : {24.0, 240.0, 960.0}) {
        double highest = 0.0;
        const std::vector<double> heights = heightsOfABounce(5.0, rate, 7.0, highest);
        // Rounding; seen 4e-15 above.
        EXPECT_LE(highest, 5.0 + 1e-12) << rate;
        // Three tops by the steps next to them: each up to g dt²/8 too low, the second of them
        // higher than the first at 960 Hz. Nothing is gained there.
        std::vector<double> tops;
        for (std::size_t i = 1; i + 1 < heights.size(); ++i) {
            if (heights[i] >= heights[i - 1] && heights[i] > heights[i + 1])
                tops.push_back(heights[i]);
        }
        ASSERT_EQ(tops.size(), 3u) << rate;
        for (const double top : tops) {
            EXPECT_LE(top, 5.0 + 1e-12) << rate;
            EXPECT_GE(top, 5.0 - 9.8 / (8.0 * rate * rate) - 1e-11) << rate;
        }
        if (rate == 960.0) {
            EXPECT_GT(tops[1] - tops[0], 1e-6);
        }
    }
}

TEST(GapBounce, WithoutSweepsNothingBounces)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 1.0);
    addPlane(world, material);
    addBody(world, exactSphere(0.5), material, {Vec3(0.0, 2.5, 0.0)});
    StepSettings settings = screeSettings();
    settings.collisionIterations = 0;
    Stepper stepper(settings);
    for (int f = 0; f < 24; ++f)
        EXPECT_EQ(stepper.advanceFrame(world, 1.0 / 24.0).sum.loopsAtTheirCap, 0) << f;
    EXPECT_NEAR(world.motion[1].position.y(), 0.5, 1e-6);
    EXPECT_NEAR(world.motion[1].velocity.y(), 0.0, 1e-9);
}

TEST(GapBounce, ABeamThatLandsOnTwoPostsAtOnceDoesNotTurn)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.5);
    for (const double x : {-1.0, 1.0}) {
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(x, 0.0, 0.0), Quat::Identity()}, 1.0);
    }
    addBody(world, boxShape({4.0, 1.0, 1.0}, 1), material, {Vec3(0.0, 1.01, 0.0), Quat::Identity()},
            4.0, Vec3(0.0, -3.0, 0.0));
    Stepper stepper(weightless());
    stepper.step(world, kStep);
    EXPECT_GT(world.motion[2].velocity.y(), -3.0 + 1.0);
    EXPECT_NEAR(world.motion[0].velocity.y(), world.motion[1].velocity.y(), 1e-3);
    // Post after post it left with 0.11 rad/s.
    EXPECT_LE(angularVelocityOf(world, 2).norm(), 1e-3);
}

// What was left wrong of the first landing made a spin, three times as fast after each bounce, and
// it tumbled after the fourth.
TEST(GapBounce, ACrateThatFallsFlatBouncesFlat)
{
    World world;
    const double restitution = 0.8, half = 0.25, height = 1.0, mass = 50.0;
    const MaterialId wood = addMaterial(world, 0.5, restitution);
    addPlane(world, wood);
    const BodyId crate = addBody(world, boxShape(Vec3(0.7, 2.0 * half, 0.5), 2), wood,
                                 {Vec3(0.1, half + height, 0.2)}, mass);
    Stepper stepper(screeSettings());
    int bounces = 0;
    double before = 0.0, rises = height;
    for (int f = 0; f < 96 && bounces < 5; ++f) {
        stepper.advanceFrame(world, 1.0 / 24.0);
        const double speed = world.motion[crate].velocity.y();
        if (before < 0.0 && speed > 0.0) {
            ++bounces;
            const double above = world.motion[crate].position.y() - half;
            const double top = above + 0.5 * speed * speed / 9.81;
            EXPECT_NEAR(top, restitution * restitution * rises, 0.02 * rises) << bounces;
            rises = top;
        }
        before = speed;
        EXPECT_LT(angularVelocityOf(world, crate).norm(), 1e-5) << f;
    }
    EXPECT_EQ(bounces, 5);
}

TEST(GapBounce, WhatLiesOnThreePostsDoesNotFallOnAFourthThatIsAHairLower)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.2);
    const auto post = boxShape({0.1, 1.0, 0.1}, 1);
    for (const auto& [x, z] : {std::pair(-0.4, -0.4), {0.4, -0.4}, {0.0, 0.4}})
        addBody(world, post, material, {Vec3(x, -0.5, z), Quat::Identity()}, 0.0);
    addBody(world, post, material, {Vec3(0.4, -0.5004, 0.4), Quat::Identity()}, 0.0);
    const BodyId plate = addBody(world, boxShape({1.0, 0.2, 1.0}, 1), material,
                                 {Vec3(0.0, 0.1, 0.0), Quat::Identity()});
    Stepper stepper(screeSettings());
    for (int i = 0; i < 10; ++i) stepper.step(world, 1.0 / 96.0);
    // A fall of 0.4 mm is nearly a step: every other step the plate fell through the three as far,
    // bounced on the fourth and was pushed out again.
    double height = world.motion[plate].position.y();
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(stepper.step(world, 1.0 / 96.0).collisionImpulses.total(), 0);
        EXPECT_GE(world.motion[plate].position.y(), height - 1e-6);
        height = world.motion[plate].position.y();
    }
}

TEST(GapBounce, ElasticBoxesInAClosedRoomKeepTheirEnergy)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0})
            addPlane(world, material, 3.0 * side * Vec3::Unit(axis), -side * Vec3::Unit(axis));
    }
    for (std::uint64_t i = 0; i < 27; ++i) {
        const auto draw = [&](std::uint64_t k) { return 6.0 * randomUnit(11, i, k) - 3.0; };
        const Vec3 place(static_cast<double>(i % 3), static_cast<double>(i / 3 % 3),
                         static_cast<double>(i / 9));
        addBody(world, exactBox(Vec3::Ones(), 1), material,
                {1.9 * (place - Vec3::Ones()), Quat::Identity()}, 1.0,
                Vec3(draw(0), draw(1), draw(2)), Vec3(draw(3), draw(4), draw(5)));
    }
    StepSettings settings = weightless();
    settings.pushOut = false;
    const double before = mechanicalEnergy(world, settings.gravity);
    Stepper stepper(settings);
    for (int i = 0; i < 240; ++i) stepper.step(world, 1.0 / 60.0);
    // What several blows to one body in a step leave; with all lever arms of the step's beginning,
    // and the angular momentum mended afterwards, up to 0.035 of it.
    EXPECT_NEAR(mechanicalEnergy(world, settings.gravity), before, 0.01 * before);
}

/// Heights of a ball that falls in a corner, or beside a wall that is not there, frame by frame
/// [m].
std::vector<double> heightsBeside(bool isWallThere, double restitution)
{
    World world;
    const MaterialId smooth = addMaterial(world, 0.0, restitution);
    addPlane(world, smooth);
    if (isWallThere) addPlane(world, smooth, Vec3(-1.0, 0.0, 0.0), Vec3::UnitX());
    const BodyId ball =
        addBody(world, exactSphere(0.1), smooth, {Vec3(-0.8689, 0.3508, 0.0), Quat::Identity()},
                1.0, Vec3(-0.586, -3.8257, 0.0));
    Stepper stepper(screeSettings());
    std::vector<double> heights;
    for (int frame = 0; frame < 6; ++frame) {
        stepper.advanceFrame(world, 1.0 / 24.0);
        heights.push_back(world.motion[ball].position.y());
    }
    return heights;
}

// It meets both within one step, but not at the same moment.
// The second one is thrown at a wall by the first, in the same step: it has been struck twice.
TEST(GapBounce, WithoutFrictionNothingTurnsBalls)
{
    for (const double gap : {0.0, 1e-3, 0.02}) {
        World world;
        const MaterialId ivory = addMaterial(world, 0.0, 1.0);
        addPlane(world, ivory, Vec3::Zero(), -Vec3::UnitX());
        const double radius = 0.1, angle = 30.0 * kPi / 180.0;
        const Vec3 second(-radius - gap, 0.0, 0.0);
        const Vec3 first = second - 2.0 * radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
        const auto ball = exactSphere(radius);
        addBody(world, ball, ivory, {Vec3(first - 0.2 * Vec3::UnitX())}, 1.0, Vec3(3.0, 0.0, 0.0));
        addBody(world, ball, ivory, {second});
        const StepSettings settings = weightless();
        Stepper stepper(settings);
        for (int f = 0; f < 12; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        for (const BodyId body : {1, 2})
            EXPECT_LT(world.motion[body].angularMomentum.norm(), 1e-12) << gap << ", " << body;
        EXPECT_NEAR(mechanicalEnergy(world, settings.gravity), 4.5, 1e-9) << gap;
        EXPECT_LT(world.motion[1].velocity.x(), 0.0) << gap;
    }
}

// The one in the middle is struck twice in a step: neither blow finds it where it would have been
// with the velocity it has after both.
TEST(GapBounce, BlowsThatFollowFromEachOtherKeepEnergyAndAngularMomentum)
{
    World world;
    const MaterialId smooth = addMaterial(world, 0.0, 1.0);
    const auto box = exactBox({0.4, 0.2, 0.3}, 1);
    for (int i = 0; i < 3; ++i) {
        addBody(world, box, smooth,
                {Vec3(0.42 * i + (i > 0 ? 0.1 : 0.0), 0.07 * i, 0.05 * i),
                 fromEulerXyz({0.1 * i, 0.2 * i, -0.1 * i})},
                1.0 + i, i == 0 ? Vec3(8.0, 0.5, 0.0) : Vec3(Vec3::Zero()));
    }
    StepSettings settings = weightless();
    settings.pushOut = false;  // moves bodies without asking for their angular momenta
    const Vec3 turning = angularMomentumOf(world);
    const double energy = mechanicalEnergy(world, settings.gravity);
    Stepper stepper(settings);
    for (int i = 0; i < 9; ++i) stepper.step(world, 1.0 / 60.0);
    EXPECT_LT((angularMomentumOf(world) - turning).norm(), 1e-12);
    // Where the middle one was taken to have come as far as with its last velocity: 2 % less.
    EXPECT_NEAR(mechanicalEnergy(world, settings.gravity), energy, 1e-3 * energy);
    EXPECT_GT(world.motion[2].velocity.x(), 0.5);
}

// The light one goes to and fro between them until the heavy one has turned: π/2 √(mass ratio)
// times.
TEST(GapBounce, WhatDrivesALightBodyAgainstAWallComesBackWithAllItsEnergy)
{
    for (const double mass : {10.0, 100.0, 1000.0}) {
        World world;
        const MaterialId ivory = addMaterial(world, 0.0, 1.0);
        addPlane(world, ivory, Vec3::Zero(), -Vec3::UnitX());
        const auto ball = exactSphere(0.1);
        const BodyId heavy =
            addBody(world, ball, ivory, {Vec3(-0.5, 0.0, 0.0)}, mass, Vec3(3.0, 0.0, 0.0));
        addBody(world, ball, ivory, {Vec3(-0.1, 0.0, 0.0)});
        const StepSettings settings = weightless();
        Stepper stepper(settings);
        for (int f = 0; f < 12; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_NEAR(mechanicalEnergy(world, settings.gravity), 4.5 * mass, 1e-3 * mass) << mass;
        EXPECT_LT(world.motion[heavy].velocity.x(), -2.0) << mass;
    }
}

// The one below is thrown at the floor and back within the step, and strikes the other again.
TEST(GapBounce, WhatFallsOnItsLikeTurnsWhereTheyTouch)
{
    World world;
    const MaterialId wood = addMaterial(world, 0.3, 0.8);
    addPlane(world, wood);
    const double height = 0.2, fall = 1.1, frame = 1.0 / 24.0;
    const auto box = exactBox({0.4, height, 0.4}, 1);
    addBody(world, box, wood, {Vec3(0.0, 0.5 * height, 0.0)});
    const BodyId upper = addBody(world, box, wood, {Vec3(0.0, 1.5 * height + fall, 0.0)});
    Stepper stepper(screeSettings());
    const double gravity = -screeSettings().gravity.y();
    const double landsAt = std::sqrt(2.0 * fall / gravity);
    const int frames = static_cast<int>(landsAt / frame) + 2;
    for (int f = 0; f < frames; ++f) stepper.advanceFrame(world, frame);
    const double since = frames * frame - landsAt;
    const BodyMotion& motion = world.motion[upper];
    const double turnedAt =
        motion.position.y() - since * motion.velocity.y() - 0.5 * gravity * since * since;
    EXPECT_NEAR(turnedAt, 1.5 * height, 1e-3);
}

TEST(GapBounce, ABallThatFallsIntoACornerIsAsHighAsWithoutTheWall)
{
    // What stays down lies a hair in the floor until push-out has lifted it.
    for (const auto& [restitution, off] : {std::pair{0.0, 3e-4}, {0.5, 1e-9}, {1.0, 1e-9}}) {
        const std::vector<double> corner = heightsBeside(true, restitution);
        const std::vector<double> free = heightsBeside(false, restitution);
        for (std::size_t i = 0; i < free.size(); ++i)
            EXPECT_NEAR(corner[i], free[i], off) << restitution << ", " << i;
    }
}

// A clump whose balls hit each other as they hit the floor: most of what follows from a blow would
// be over before the step is.
TEST(GapBounce, AClumpThatLandsIsNotStruckByBouncesThatNoStepCouldShow)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.3);
    addPlane(world, material, Vec3::Zero(), Vec3::UnitY());
    for (std::uint64_t i = 0; i < 64; ++i) {
        const Vec3 place(static_cast<double>(i % 4), static_cast<double>(i / 4 % 4),
                         static_cast<double>(i / 16));
        const Vec3 aside(0.02 * randomUnit(5, i, 0), 0.0, 0.02 * randomUnit(5, i, 1));
        addBody(world, exactSphere(0.5), material,
                {1.01 * place + aside + 0.6 * Vec3::UnitY(), Quat::Identity()}, 1.0,
                Vec3(0.0, -3.0, 0.0));
    }
    Stepper stepper(screeSettings());
    std::int64_t blows = 0;
    for (int i = 0; i < 60; ++i) blows += stepper.step(world, kStep).collisionImpulses.total();
    // Of 64 balls. With all that came again there were 1216.
    EXPECT_GT(blows, 64);
    EXPECT_LT(blows, 1000);
}

}  // namespace
}  // namespace scree::test
