// Method `scree`: what goes by is not hit, and what hits is not let through.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;

BodyId addSlab(World& world, MaterialId material, const Vec3& size, const Vec3& centre)
{
    return addFixed(world, material, boxShape(size, 1), {centre, Quat::Identity()});
}

StepSettings settingsWith(double gravity)
{
    StepSettings settings = screeSettings();
    settings.gravity = {0.0, -gravity, 0.0};
    return settings;
}

void run(World& world, double gravity, double seconds, double frame = kFrame)
{
    Stepper stepper(settingsWith(gravity));
    for (int f = 0; f < std::lround(seconds / frame); ++f) stepper.advanceFrame(world, frame);
}

/// What flies at 5 m/s to +x over the edge of a block, whose top is at y = 0, with room to spare.
World overAnEdge(std::shared_ptr<const Shape> shape, double lowest, double clearance)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    addSlab(world, material, {4.0, 1.0, 2.0}, {3.03, -0.5, 0.0});
    addBody(world, std::move(shape), material, {{-1.0, clearance - lowest, 0.0}, Quat::Identity()},
            1.0, {5.0, 0.0, 0.0});
    return world;
}

TEST(GapForesight, WhatFliesOverAnEdgeDoesNotFeelIt)
{
    for (const double clearance : {0.001, 0.005, 0.02, 0.05}) {
        for (const bool isBall : {false, true}) {
            World world = overAnEdge(isBall ? exactSphere(0.25) : boxShape(Vec3::Constant(0.5), 1),
                                     -0.25, clearance);
            run(world, 0.0, 1.0);
            EXPECT_LE((world.motion[1].velocity - Vec3(5.0, 0.0, 0.0)).norm(), 1e-3)
                << clearance << (isBall ? " ball" : " cube");
            EXPECT_LE(angularVelocityOf(world, 1).norm(), 1e-3) << clearance;
        }
    }
}

TEST(GapForesight, WhatStandsInTheWayOfItIsHit)
{
    for (const double clearance : {-0.02, -0.1, -0.3}) {
        World world = overAnEdge(boxShape(Vec3::Constant(0.5), 1), -0.25, clearance);
        run(world, 0.0, 1.0);
        EXPECT_LE(world.motion[1].velocity.x(), 4.0) << clearance;
    }
}

TEST(GapForesight, TwoThatFlyPastEachOtherDoNotMeet)
{
    for (const bool isBall : {false, true}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.5);
        const auto shape = isBall ? exactSphere(0.2) : boxShape(Vec3::Constant(0.4), 1);
        addBody(world, shape, material, {{-2.0, 0.42, 0.0}, Quat::Identity()}, 1.0,
                {5.0, 0.0, 0.0});
        addBody(world, shape, material, {{0.013, 0.0, 0.0}, Quat::Identity()});
        run(world, 0.0, 1.0);
        EXPECT_LE((world.motion[0].velocity - Vec3(5.0, 0.0, 0.0)).norm(), 1e-3) << isBall;
        EXPECT_LE(world.motion[1].velocity.norm(), 1e-3) << isBall;
    }
}

/// After a step in which the floor throws up one of two balls that would have passed each other by
/// a hundredth of their radius, when the line between them is `degrees` off the vertical.
double overlapWithOneThrownUp(double degrees, double speed, double fall)
{
    constexpr double kRadius = 0.1, kStep = 1.0 / 96.0;
    const double angle = degrees * kPi / 180.0;
    const Vec3 line(std::sin(angle), std::cos(angle), 0.0);
    const Vec3 across(std::cos(angle), -std::sin(angle), 0.0);
    World world;
    const MaterialId material = addMaterial(world, 0.0, 1.0);
    addPlane(world, material);
    const Vec3 low(0.0, 1.05 * kRadius, 0.0), falling(0.0, -fall, 0.0);
    const Vec3 high = low + 2.01 * kRadius * line - 0.5 * kStep * speed * across;
    addBody(world, exactSphere(kRadius), material, {low, Quat::Identity()}, 1.0, falling);
    addBody(world, exactSphere(kRadius), material, {high, Quat::Identity()}, 1.0,
            falling + speed * across);
    Stepper(settingsWith(0.0)).step(world, kStep);
    const double apart = (world.motion[2].position - world.motion[1].position).norm();
    return 1.0 - apart / (2.0 * kRadius);
}

TEST(GapForesight, WhatIsThrownUpHitsWhatWouldHavePassedIt)
{
    for (const double degrees : {-80.0, -60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0, 80.0}) {
        for (const double speed : {4.0, 8.0, 16.0}) {
            for (const double fall : {1.0, 2.0, 4.0}) {
                EXPECT_LE(overlapWithOneThrownUp(degrees, speed, fall), 0.005)
                    << degrees << " degrees, " << speed << " and " << fall << " m/s";
            }
        }
    }
}

TEST(GapForesight, ABallThatFollowsAnotherDoesNotRunIntoItWhenThatIsStopped)
{
    // What both have of their speed in common is not looked for, until one is stopped. How far the
    // two are apart is known to the rounding of how far they have come, which must not hide where
    // they touch.
    constexpr double kRadius = 0.03, kStep = 1.0 / 144.0, kSpeed = 3.0;
    const auto ball = buildMeshShape("ball", makeSphere(kRadius, 3));
    for (int i = 0; i < 40; ++i) {
        World world;
        const MaterialId material = addMaterial(world, 0.0, 0.2);
        addPlane(world, material);
        const Vec3 low(0.1 * i, kRadius + 40.3 * kStep * kSpeed, 0.0);
        const Vec3 way = Vec3(0.3 + 0.01 * i, 1.0, -0.2).normalized();
        const Vec3 high = low + (2.0 * kRadius + 0.004 + 1e-4 * i) * way;
        for (const Vec3& place : {low, high}) {
            addBody(world, ball, material, {place, Quat::Identity()}, 1.0, -kSpeed * Vec3::UnitY());
        }
        Stepper stepper(settingsWith(0.0));
        for (int step = 0; step < 42; ++step) {
            stepper.step(world, kStep);
            const double apart = (world.motion[2].position - world.motion[1].position).norm();
            EXPECT_GE(apart, (2.0 - 5e-3) * kRadius) << i << " after " << step;
        }
    }
}

TEST(GapForesight, APlateThatIsThrownUpIsNotCutIntoByOneThatWouldHavePassedOver)
{
    // Over its rim by a tenth of a millimetre, if the floor did not throw it up before the step
    // ends.
    constexpr double kStep = 1.0 / 96.0, kThick = 0.008, kFall = 0.3, kFalls = 0.75 * kStep;
    for (const double speed : {4.0, 8.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.0, 1.0);
        addPlane(world, material);
        const auto plate = exactBox({0.6, kThick, 0.3}, 1);
        const Vec3 low(0.0, 0.5 * kThick + kFalls * kFall, 0.0), falling(0.0, -kFall, 0.0);
        const Vec3 high = low + Vec3(0.6 + 0.2 * speed * kStep, kThick + 1e-4, 0.05);
        addBody(world, plate, material, {low, Quat::Identity()}, 1.0, falling);
        addBody(world, plate, material, {high, Quat::Identity()}, 1.0,
                falling - speed * Vec3::UnitX());
        Stepper(settingsWith(0.0)).step(world, kStep);
        const Vec3 apart = (world.motion[2].position - world.motion[1].position).cwiseAbs();
        const double overlap = std::min(0.6 - apart.x(), kThick - apart.y());
        EXPECT_LE(overlap, 0.1 * kThick) << speed;
    }
}

TEST(GapForesight, BallsHitEachOtherAlongTheLineTheyHaveThen)
{
    constexpr double kRadius = 0.02857, kSpeed = 2.0;
    for (const bool isMesh : {false, true}) {
        const auto ball =
            isMesh ? buildMeshShape("ball", makeSphere(kRadius, 3)) : exactSphere(kRadius);
        for (const double degrees : {15.0, 30.0, 45.0, 60.0, 75.0}) {
            for (const double start : {-0.3, -0.317, -0.33}) {
                const double cut = degrees * kPi / 180.0;
                World world;
                const MaterialId material = addMaterial(world, 0.0, 1.0);
                addBody(world, ball, material,
                        {{start, 0.0, 2.0 * kRadius * std::sin(cut)}, Quat::Identity()}, 0.17,
                        {kSpeed, 0.0, 0.0});
                addBody(world, ball, material, {}, 0.17);
                run(world, 0.0, 0.5);
                const Vec3 along(std::cos(cut), 0.0, -std::sin(cut));
                const Vec3 object = kSpeed * std::cos(cut) * along;
                const Vec3 cue = Vec3(kSpeed, 0.0, 0.0) - object;
                EXPECT_LE((world.motion[1].velocity - object).norm(), 1e-4 * kSpeed)
                    << degrees << " " << start << (isMesh ? " mesh" : "");
                EXPECT_LE((world.motion[0].velocity - cue).norm(), 1e-4 * kSpeed)
                    << degrees << " " << start << (isMesh ? " mesh" : "");
                EXPECT_LE(kRadius * angularVelocityOf(world, 1).norm(), 1e-4 * kSpeed) << degrees;
            }
        }
    }
}

TEST(GapForesight, BallsHitTheSideOfACapsuleAcrossItsAxis)
{
    constexpr double kSpeed = 4.0;
    const auto capsule = buildMeshShape("capsule", makeCapsule(0.5, 3.0, 64, 24));
    for (const bool isMesh : {false, true}) {
        const auto ball = isMesh ? buildMeshShape("ball", makeSphere(0.3, 3)) : exactSphere(0.3);
        for (const double degrees : {5.0, 20.0, 33.0, 46.0, 60.0}) {
            const double cut = degrees * kPi / 180.0;
            World world;
            const MaterialId material = addMaterial(world, 0.0, 0.8);
            BodyDefinition target;
            target.name = "target";
            target.shape = world.addShape(capsule);
            target.material = material;
            target.kind = BodyKind::fixed;
            world.addBody(target);
            addBody(world, ball, material, {{-2.0, 0.7, 0.8 * std::sin(cut)}, Quat::Identity()},
                    1.0, {kSpeed, 0.0, 0.0});
            run(world, 0.0, 0.6);
            const Vec3 blow = world.motion[1].velocity - Vec3(kSpeed, 0.0, 0.0);
            const Vec3 across(-std::cos(cut), 0.0, std::sin(cut));
            EXPECT_LE((blow - 1.8 * kSpeed * std::cos(cut) * across).norm(), 1e-3 * kSpeed)
                << degrees << (isMesh ? " mesh" : "");
        }
    }
}

/// What slides without friction over four blocks, each `lower` than the one before, at a speed.
World overSeams(std::shared_ptr<const Shape> shape, const Quat& orientation, double lower,
                double speed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    for (int i = 0; i < 4; ++i)
        addSlab(world, material, {4.0, 1.0, 4.0}, {4.0 * i, -0.5 - lower * i, 0.0});
    addBody(world, std::move(shape), material, {{0.0, 0.25, 0.0}, orientation}, 1.0,
            {speed, 0.0, 0.0});
    return world;
}

TEST(GapForesight, SeamsBetweenFlushBlocksStopNothing)
{
    const Quat yawed = fromEulerXyz({0.0, 10.0 * kPi / 180.0, 0.0});
    for (const double frame : {kFrame, 1.0 / 240.0}) {
        for (const double lower : {0.0, 0.001}) {
            for (const Quat& orientation : {Quat(Quat::Identity()), yawed}) {
                World world = overSeams(boxShape(Vec3::Constant(0.5), 1), orientation, lower, 5.0);
                double highest = 0.0;
                Stepper stepper(settingsWith(9.81));
                for (int f = 0; f < std::lround(2.0 / frame); ++f) {
                    stepper.advanceFrame(world, frame);
                    highest = std::max(highest, world.motion[4].position.y());
                }
                EXPECT_NEAR(world.motion[4].velocity.x(), 5.0, 0.05)
                    << 1.0 / frame << " " << lower << " " << orientation.y();
                EXPECT_LE(highest, 0.252) << 1.0 / frame << " " << lower << " " << orientation.y();
            }
        }
    }
}

TEST(GapForesight, ABallRollsOverASeamWithoutAHop)
{
    World world = overSeams(exactSphere(0.25), Quat::Identity(), 0.0, 5.0);
    double highest = 0.0;
    Stepper stepper(settingsWith(9.81));
    for (int f = 0; f < 48; ++f) {
        stepper.advanceFrame(world, kFrame);
        highest = std::max(highest, world.motion[4].position.y());
    }
    EXPECT_NEAR(world.motion[4].velocity.x(), 5.0, 0.01);
    EXPECT_LE(highest, 0.251);
}

TEST(GapForesight, AStepAtASeamIsHit)
{
    World world = overSeams(boxShape(Vec3::Constant(0.5), 1), Quat::Identity(), -0.05, 5.0);
    run(world, 9.81, 1.0);
    EXPECT_LE(world.motion[4].velocity.x(), 4.0);
}

TEST(GapForesight, NothingIsShotThroughAThinWall)
{
    for (const double speed : {20.0, 60.0, 200.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.2);
        addSlab(world, material, {0.05, 2.0, 2.0}, Vec3::Zero());
        addBody(world, boxShape(Vec3::Constant(0.5), 1), material,
                {{-2.0, 0.03, 0.02}, fromEulerXyz({0.3, 0.5, 0.7})}, 1.0, {speed, 0.0, 0.0});
        run(world, 0.0, 0.5);
        EXPECT_LT(world.motion[1].position.x(), 0.0) << speed;
    }
}

/// A plate of 8 mm that flies past another, without turning.
struct ThrownPlate {
    Pose fixed, thrown;
    Vec3 velocity;
};

const Vec3 kPlate(0.6, 0.008, 0.3);

ThrownPlate drawPlate(int number)
{
    int drawn = 0;
    const auto share = [&] { return 2.0 * randomUnit(5, number, drawn++) - 1.0; };
    const auto vector = [&] {
        const double x = share(), y = share();
        return Vec3(x, y, share());
    };
    const auto turned = [&] { return fromEulerXyz(kPi * vector()); };
    const Vec3 way = vector().normalized();
    return {
        {Vec3::Zero(), turned()}, {0.15 * vector() - way, turned()}, (12.0 + 8.0 * share()) * way};
}

/// Whether some place on an edge of the first plate is at least a millimetre inside the second.
bool hasEdgeInside(const Pose& secondFromFirst)
{
    constexpr int kPlaces = 60;
    for (int axis = 0; axis < 3; ++axis) {
        for (int edge = 0; edge < 4; ++edge) {
            for (int i = 0; i <= kPlaces; ++i) {
                Vec3 place = 0.5 * kPlate;
                place[axis] *= 2.0 * i / kPlaces - 1.0;
                place[(axis + 1) % 3] *= edge % 2 == 0 ? 1.0 : -1.0;
                place[(axis + 2) % 3] *= edge < 2 ? 1.0 : -1.0;
                const Vec3 inside = 0.5 * kPlate - (secondFromFirst * place).cwiseAbs();
                if (inside.minCoeff() >= 0.001) return true;
            }
        }
    }
    return false;
}

bool isInTheWay(const ThrownPlate& plate, double seconds)
{
    const double step = 0.002 / plate.velocity.norm();
    for (double t = 0.0; t < seconds; t += step) {
        const Pose then{plate.thrown.position + t * plate.velocity, plate.thrown.orientation};
        const Pose fixedFromThrown = inverse(plate.fixed) * then;
        if (hasEdgeInside(fixedFromThrown) || hasEdgeInside(inverse(fixedFromThrown))) return true;
    }
    return false;
}

TEST(GapForesight, NoPlateFliesThroughAnother)
{
    // Edge to edge they are seen for a moment only, and in that they must not be let pass.
    constexpr double kSeconds = 4.0 * kFrame;
    ShapeSettings asInShots;
    asInShots.enoughNodes = 1'000'000;
    const auto shape = buildMeshShape("plate", makeBox(kPlate, {1, 1, 1}), asInShots);
    int inTheWay = 0;
    for (int i = 0; i < 100; ++i) {
        const ThrownPlate plate = drawPlate(i);
        if (!isInTheWay(plate, kSeconds)) continue;
        ++inTheWay;
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.2);
        addFixed(world, material, shape, plate.fixed);
        addBody(world, shape, material, plate.thrown, 1.0, plate.velocity);
        run(world, 0.0, kSeconds);
        EXPECT_GT((world.motion[1].velocity - plate.velocity).norm(), 0.01) << i;
    }
    EXPECT_GE(inTheWay, 60);
}

// Of a pair some of whose corners were about to be hit the others carried with arms of that moment,
// and their impulses were written with their own: chips that a block of twenty thousand times their
// weight pressed onto stones were spun through it, by up to 32 mm.
TEST(GapForesight, WhatIsCrushedTurnsAsItWasSolvedTo)
{
    World world;
    const MaterialId material = addMaterial(world, 0.6, 0.2, 2500.0);
    addPlane(world, material);
    const Pose tilted{{0.0, 2.9, 0.0},
                      Quat(Eigen::AngleAxisd(0.07, Vec3(1.0, 0.0, 0.5).normalized()))};
    addBody(world, boxShape({1.6, 4.0, 1.6}, 1), material, tilted, 25600.0);
    const auto addLayer = [&](int count, const std::shared_ptr<const Shape>& shape, double height,
                              double mass) {
        for (int i = 0; i < count * count; ++i) {
            const double x = 0.2 * (i % count - 0.5 * (count - 1));
            const double z = 0.2 * (i / count - 0.5 * (count - 1));
            addBody(world, shape, material, {Vec3(x, height, z)}, mass);
        }
    };
    addLayer(7, buildMeshShape("stone", makeSphere(0.05, 1)), 0.06, 1.1);
    addLayer(6, boxShape({0.12, 0.03, 0.06}, 1), 0.2, 0.54);
    Stepper stepper(screeSettings());
    for (int k = 0; k < 40; ++k)
        ASSERT_LT(stepper.advanceFrame(world, kFrame).sum.deepestBeforePushOut, 3e-3) << k;
}

}  // namespace
}  // namespace scree::test
