// What swings or rides on what turns goes round, and does not leave its circle bit by bit.
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

// The energy is counted once the ring hangs tight. By the tangent of each step's beginning the ring
// lost 2.9 J, and with a quarter of the step 0.8 J.
TEST(GapSwings, ARingThatHangsInAnotherKeepsItsEnergy)
{
    World world;
    StepSettings settings = screeSettings();
    settings.substeps.min = settings.substeps.max = 8;
    const MaterialId material = addMaterial(world, 1.0, 0.0);
    const double inner = 0.35, mass = 10.0;
    const auto ring = buildMeshShape("ring", makeTorus(0.4, 0.4 - inner, {96, 32}));
    addFixed(world, material, ring, {Vec3::Zero(), exponentialMap({0.5 * kPi, 0.0, 0.0})});
    const Quat leaning = exponentialMap({0.0, 0.0, kPi / 3.0});
    addBody(world, ring, material,
            {Vec3(0.0, -inner, 0.0) + leaning * Vec3(0.0, -inner, 0.0),
             leaning * exponentialMap({0.0, 0.0, 0.5 * kPi})},
            mass);
    Stepper stepper(settings);
    const auto energyAfter = [&](int frames) {
        for (int k = 0; k < frames; ++k) stepper.advanceFrame(world, kFrame);
        return mechanicalEnergy(world, settings.gravity);
    };
    const double start = energyAfter(12), end = energyAfter(72);
    const double hanging = -mass * settings.gravity.norm() * 2.0 * inner;
    EXPECT_GT(start - hanging, 15.0);
    EXPECT_LT(end, start);
    EXPECT_GT(end, start - 1.9);
}

// By the places of each step's beginning the blocks were 96 mm farther out after 8 s, and the disc
// turned by 114.7 degrees a second.
TEST(GapSwings, WhatRidesOnADiscThatTurnsStaysThere)
{
    World world;
    const MaterialId rough = addMaterial(world, 0.9, 0.0), ice = addMaterial(world, 0.0, 0.0);
    world.materialPairs.push_back({ice, rough, 0.0, {}});
    addPlane(world, ice);
    const double turning = 120.0 * kPi / 180.0;
    const Vec3 spin(0.0, turning, 0.0);
    const BodyId disc = addBody(world, buildMeshShape("disc", makeCylinder(1.0, 0.1, 64, 2)), rough,
                                {Vec3(0.0, 0.05, 0.0)}, 250.0, Vec3::Zero(), spin);
    const auto block = boxShape(Vec3::Constant(0.25), 2);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 place(0.5 * side, 0.225, 0.0);
        addBody(world, block, rough, {place}, 31.0, spin.cross(place), spin);
    }
    Stepper stepper(screeSettings());
    for (int f = 0; f < 8 * 24; ++f) stepper.advanceFrame(world, kFrame);
    for (const BodyId rider : {disc + 1, disc + 2}) {
        const Vec3 out = world.motion[rider].position - world.motion[disc].position;
        EXPECT_NEAR(std::hypot(out.x(), out.z()), 0.5, 2e-3) << rider;
    }
    EXPECT_NEAR(angularVelocityOf(world, disc).y(), turning, 1e-3 * turning);
}

/// Half of a cylinder along z, its round side down, about the axis of the whole.
TriMesh halfCylinder(double radius, double width, int sides)
{
    const Eigen::Index count = sides + 1;
    TriMesh mesh{Points(3, 2 * count), Triangles(3, 4 * sides)};
    for (Eigen::Index k = 0; k < count; ++k) {
        const double angle = kPi * (1.0 + static_cast<double>(k) / sides);
        const Vec3 onRim(radius * std::cos(angle), radius * std::sin(angle), 0.5 * width);
        mesh.points.col(k) = onRim;
        mesh.points.col(count + k) = onRim - width * Vec3::UnitZ();
    }
    Eigen::Index t = 0;
    const auto add = [&](int a, int b, int c) { mesh.triangles.col(t++) << a, b, c; };
    const int back = static_cast<int>(count);
    for (int k = 0; k < sides; ++k) {
        add(k, back + k, k + 1);
        add(k + 1, back + k, back + k + 1);
        if (k == 0) continue;
        add(0, k, k + 1);
        add(back, back + k + 1, back + k);
    }
    add(0, sides, back);
    add(sides, back + sides, back);
    return mesh;
}

/// The lower half of a pipe along z about the origin.
TriMesh halfPipe(double inner, double outer, double width, int sides)
{
    const int row = 4;  // inner and outer in front, inner and outer behind
    TriMesh mesh{Points(3, row * (sides + 1)), Triangles(3, 8 * sides + 4)};
    Eigen::Index t = 0;
    const auto quad = [&](int a, int b, int c, int d) {
        mesh.triangles.col(t++) << a, b, c;
        mesh.triangles.col(t++) << a, c, d;
    };
    for (int k = 0; k <= sides; ++k) {
        const double angle = kPi * (1.0 + static_cast<double>(k) / sides);
        for (int i = 0; i < row; ++i) {
            const double radius = i % 2 == 0 ? inner : outer;
            mesh.points.col(row * k + i) << radius * std::cos(angle), radius * std::sin(angle),
                (i < 2 ? 0.5 : -0.5) * width;
        }
        if (k == sides) break;
        const int a = row * k, b = a + row;
        quad(a, b, b + 2, a + 2);          // inside
        quad(a + 1, a + 3, b + 3, b + 1);  // outside
        quad(a, a + 1, b + 1, b);          // in front
        quad(a + 2, b + 2, b + 3, a + 3);  // behind
    }
    const int last = row * sides;
    quad(0, 2, 3, 1);
    quad(last, last + 1, last + 3, last + 2);
    return mesh;
}

struct Rocking {
    double start = 0.0, most = -1e300;  // energy of the swing [J]
    double pushOutWork = 0.0;           // [J]
    double slid = 0.0;                  // at most [m]
};

/// `lowest`: potential energy where it would rest [J]. `slid`: how far it has left the way on which
/// it rolls.
template <class Slid>
Rocking rock(World& world, double seconds, double lowest, const Slid& slid)
{
    const StepSettings settings = screeSettings();
    Stepper stepper(settings);
    Rocking rocking;
    rocking.start = mechanicalEnergy(world, settings.gravity) - lowest;
    for (int f = 0; f < static_cast<int>(24.0 * seconds); ++f) {
        rocking.pushOutWork += stepper.advanceFrame(world, kFrame).sum.pushOutWork;
        rocking.most = std::max(rocking.most, mechanicalEnergy(world, settings.gravity) - lowest);
        rocking.slid = std::max(rocking.slid, std::abs(slid()));
    }
    return rocking;
}

double angleAboutZ(const BodyMotion& motion)
{
    return 2.0 * std::atan2(motion.orientation.z(), motion.orientation.w());
}

// Both gained energy at any number of steps that a shot would have, half of it in 20 s and without
// end: where they were slow they moved by the mean of velocities, and where they were fast not; and
// push-out lifted them by one and a half times and twice the energy of the swing.
TEST(GapSwings, HalfACylinderThatRocksGainsNothing)
{
    World world;
    const MaterialId rough = addMaterial(world, 1.0, 0.0);
    addPlane(world, rough);
    const double radius = 0.5, mass = 100.0, tilt = 0.3;
    const auto shape = buildMeshShape("half", halfCylinder(radius, 0.4, 64));
    const BodyId half = addBody(world, shape, rough,
                                {Vec3(0.0, radius, 0.0), exponentialMap({0.0, 0.0, tilt})}, mass);
    const double below = 4.0 * radius / (3.0 * kPi), g = 9.81;
    const Rocking rocking = rock(world, 20.0, mass * g * (radius - below), [&] {
        const Pose pose = world.worldFromAsset(half);
        return pose.position.x() + radius * (angleAboutZ(world.motion[half]) - tilt);
    });
    EXPECT_LT(rocking.most, 1.05 * rocking.start);
    EXPECT_LT(rocking.pushOutWork, 0.05 * rocking.start);
    EXPECT_LT(rocking.slid, 1e-3 * radius);
    EXPECT_GT(world.motion[half].angularMomentum.norm(), 0.0) << "it rocks on";
}

// With 400 sweeps it was taken for a heap, whose swings nobody holds.
TEST(GapSwings, WhatRocksIsNoHeapHoweverManySweepsThatMayHave)
{
    const auto angleAfter = [](int sweepsOfAHeap) {
        World world;
        const MaterialId rough = addMaterial(world, 1.0, 0.0);
        addPlane(world, rough);
        const BodyId half =
            addBody(world, buildMeshShape("half", halfCylinder(0.5, 0.4, 64)), rough,
                    {Vec3(0.0, 0.5, 0.0), exponentialMap({0.0, 0.0, 0.3})}, 100.0);
        StepSettings settings = screeSettings();
        settings.gapSweeps = sweepsOfAHeap;
        Stepper stepper(settings);
        for (int f = 0; f < 120; ++f) stepper.advanceFrame(world, kFrame);
        return angleAboutZ(world.motion[half]);
    };
    EXPECT_NEAR(angleAfter(400), angleAfter(12), 1e-6);
}

TEST(GapSwings, APlankThatRocksOnABarrelGainsNothing)
{
    World world;
    const MaterialId rough = addMaterial(world, 1.0, 0.0);
    const double radius = 0.5, thick = 0.1, mass = 45.0, tilt = 0.26, g = 9.81;
    addFixed(world, rough, exactCylinder(radius, 1.0),
             {Vec3::Zero(), exponentialMap({0.5 * kPi, 0.0, 0.0})});
    // It has rolled to there from where it lay level.
    const Quat leaning = exponentialMap({0.0, 0.0, -tilt});
    const Vec3 normal = leaning * Vec3::UnitY(), along = leaning * Vec3::UnitX();
    const BodyId plank =
        addBody(world, exactBox({1.5, thick, 0.3}, 1), rough,
                {(radius + 0.5 * thick) * normal - radius * tilt * along, leaning}, mass);
    const Rocking rocking = rock(world, 20.0, mass * g * (radius + 0.5 * thick), [&] {
        const double angle = -angleAboutZ(world.motion[plank]);
        const Vec3 reaches = world.motion[plank].orientation * Vec3::UnitX();
        return world.motion[plank].position.dot(reaches) + radius * angle;
    });
    EXPECT_LT(rocking.most, 1.06 * rocking.start);
    EXPECT_LT(rocking.pushOutWork, 0.2 * rocking.start);
    EXPECT_LT(rocking.slid, 1e-3 * radius);
    EXPECT_GT(world.motion[plank].angularMomentum.norm(), 0.0) << "it rocks on";
}

/// A pyramid of many sides on its point, with another on its base.
TriMesh topMesh(double radius, double height, int sides)
{
    TriMesh mesh{Points(3, sides + 2), Triangles(3, 2 * sides)};
    mesh.points.col(sides) = Vec3::Zero();
    mesh.points.col(sides + 1) = 1.5 * height * Vec3::UnitY();
    for (int k = 0; k < sides; ++k) {
        const double angle = 2.0 * kPi * k / sides;
        mesh.points.col(k) = Vec3(radius * std::cos(angle), height, radius * std::sin(angle));
        const int next = (k + 1) % sides;
        mesh.triangles.col(2 * k) << sides, k, next;
        mesh.triangles.col(2 * k + 1) << sides + 1, next, k;
    }
    return mesh;
}

// Steadily, at the rate W for which I1 W² cos a - I3 w W + m g l = 0 [Goldstein, heavy symmetric
// top], and turning by half a radian in a step: it lay on its side in the end. What is
// missing falls with the square of the step.
TEST(GapSwings, ATopGoesRoundAtItsTiltAsTheorySays)
{
    World world;
    const MaterialId rough = addMaterial(world, 1.0, 0.0);
    addPlane(world, rough);
    const double tilt = 0.35, mass = 0.1, g = 9.81, spin = 150.0;
    const Quat leaning = exponentialMap({0.0, 0.0, -tilt});
    const Vec3 axis = leaning * Vec3::UnitY();
    const BodyId top = addBody(world, buildMeshShape("top", topMesh(0.03, 0.03, 16)), rough,
                               {Vec3::Zero(), leaning}, mass);
    const double arm = world.motion[top].position.norm();
    const Mat3 inertia = inverseInertiaWorld(world.motion[top].orientation.toRotationMatrix(),
                                             world.mass[top].inverseInertia)
                             .inverse();
    const double about = axis.dot(inertia * axis);
    const double across = inertia(2, 2) + mass * arm * arm;
    const double c = across * std::cos(tilt), b = about * spin;
    const double rate = (b - std::sqrt(b * b - 4.0 * c * mass * g * arm)) / (2.0 * c);
    const Vec3 w = rate * Vec3::UnitY() + (spin - rate * std::cos(tilt)) * axis;
    world.motion[top].angularMomentum = inertia * w;
    world.motion[top].velocity = w.cross(world.motion[top].position);

    Stepper stepper(screeSettings());
    const int frames = 96;
    double least = tilt, most = tilt, gone = 0.0;
    Vec3 before = axis;
    for (int f = 0; f < frames; ++f) {
        EXPECT_LE(stepper.advanceFrame(world, kFrame).steps, 12);
        const Vec3 now = world.worldFromAsset(top).orientation * Vec3::UnitY();
        gone += std::atan2(before.z() * now.x() - before.x() * now.z(),
                           before.x() * now.x() + before.z() * now.z());
        before = now;
        least = std::min(least, std::acos(now.y()));
        most = std::max(most, std::acos(now.y()));
    }
    EXPECT_NEAR(least, tilt, 0.03);
    EXPECT_NEAR(most, tilt, 0.03);
    EXPECT_NEAR(gone / (frames * kFrame), rate, 0.04 * rate);
}

/// Where a coin that leans into its curve has rolled to in a second.
Vec3 rolledTo(int steps)
{
    World world;
    const MaterialId gold =
        world.addMaterial({"gold", 1.9e4, 0.25, 0.35, {.rolling = 3.5e-5, .spinning = 3e-5}});
    addPlane(world, gold);
    const double radius = 0.013;
    const BodyId coin =
        addBody(world, buildMeshShape("coin", makeCylinder(radius, 0.0022, 48, 2)), gold,
                {Vec3(0.0, 0.0129, 0.0), exponentialMap({82.0 * kPi / 180.0, 0.0, 0.0})}, 0.01,
                Vec3(0.26, 0.0, 0.0), Vec3(0.0, 0.52, -20.0));
    StepSettings settings = screeSettings();
    settings.substeps.min = settings.substeps.max = steps;
    Stepper stepper(settings);
    for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, kFrame);
    return world.motion[coin].position;
}

// In the smallest steps each was taken for the first of a swing, and half of what turned it was
// given back.
TEST(GapSwings, ACoinRollsTheSameWayInSmallAndVerySmallSteps)
{
    EXPECT_LT((rolledTo(64) - rolledTo(256)).norm(), 4e-3);  // seen: 2 mm, and 7 mm
}

// Without friction: it never turns, and goes straight on each facet.
TEST(GapSwings, ABallThatSlidesToAndFroInAHollowOfFacetsGainsNothing)
{
    World world;
    const MaterialId ice = addMaterial(world, 0.0, 0.0);
    const double radius = 1.0, ball = 0.1, mass = 4.0, tilt = 0.3, g = 9.81;
    addFixed(world, ice, buildMeshShape("pipe", halfPipe(radius, 1.3, 1.0, 128)), {});
    addBody(world, exactSphere(ball), ice,
            {(radius - ball) * Vec3(std::sin(tilt), -std::cos(tilt), 0.0)}, mass);
    const Rocking rocking = rock(world, 20.0, -mass * g * (radius - ball), [] { return 0.0; });
    EXPECT_LT(rocking.most, 1.05 * rocking.start);
}

}  // namespace
}  // namespace scree::test
