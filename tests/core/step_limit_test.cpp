// The limit of the time step within a frame; that nothing tunnels is E12 of scree verify.  [A16]
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/dynamics/step_limit.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(StepLimit, StepsThatMustBecomeShorterWithinAFrameDoNotHalveToItsEnd)
{
    // So fast a fall that every frame ends with fourteen steps a frame more than it began with.
    // What was left of the frame once made the next step halve, and the next, down to the cap.
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    // Along a wall, which it never touches but for all its speed can say might.
    addBody(world, exactBox({0.2, 14000.0, 2.0}, 1), material,
            {Vec3(-0.3, 0.0, 0.0), Quat::Identity()}, 0.0);
    addBody(world, boxShape({0.2, 0.2, 0.2}, 1), material, {Vec3(0, 6000, 0), Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    settings.gravity = {0.0, -800.0, 0.0};
    Stepper stepper(settings);
    const double frame = 1.0 / 24.0;
    for (int i = 1; i <= 15; ++i) {
        const FrameReport report = stepper.advanceFrame(world, frame);
        EXPECT_FALSE(report.substepCapReached) << i;
        // Half of the box's inner thickness a step at the speed it ends with, in twos.
        const double speed = 800.0 * frame * i;
        const double wanted = std::ceil(frame * speed / (0.5 * 0.2) / 2.0) * 2.0;
        // Nor may it fall by a fiftieth of it in a step.
        if (speed < 0.1 * std::sqrt(800.0 / (0.02 * 0.2))) continue;
        EXPECT_LE(report.steps, wanted + 4.0) << i;
        EXPECT_GE(report.shortestStep, frame / (1.2 * wanted + 8.0)) << i;
    }
}

/// Steps of the first frame of a block that spins so far above another, in method `scree`.
int stepsOfSpinning(double height, double spin)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const auto block = boxShape({1.0, 1.0, 1.0}, 1);
    addBody(world, block, material, {Vec3::Zero(), Quat::Identity()});
    addBody(world, block, material, {Vec3(0, 1.0 + height, 0), Quat::Identity()}, 1.0, Vec3::Zero(),
            {0.0, spin, 0.0});
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    return Stepper(settings).advanceFrame(world, 1.0 / 24.0).steps;
}

TEST(StepLimit, WhatSpinsBesideAnotherTurnsLittleInAStep)
{
    // 0.08 rad at the default safety, where gaps known to first order are off by a third of a
    // percent of the radius; four at least, and an even number.
    EXPECT_EQ(stepsOfSpinning(0.1, 5.0), 4);
    EXPECT_EQ(stepsOfSpinning(0.1, 10.0), 6);
    EXPECT_EQ(stepsOfSpinning(0.1, 14.0), 8);
    EXPECT_EQ(stepsOfSpinning(0.1, 22.0), 12);
    EXPECT_LE(stepsOfSpinning(60.0, 22.0), 4);  // where it meets nothing
}

/// Steps of the first frame of two boxes of which one comes at the other with this speed.
int stepsOfMeeting(Method method, const Vec3& size, double speed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const auto box = exactBox(size, 1);
    addBody(world, box, material, {Vec3::Zero(), Quat::Identity()});
    addBody(world, box, material, {Vec3(0.0, speed / 24.0, 0.0), Quat::Identity()}, 1.0,
            {0.0, -speed, 0.0});
    StepSettings settings = experimentSettings();
    settings.method = method;
    return Stepper(settings).advanceFrame(world, 1.0 / 24.0).steps;
}

TEST(StepLimit, WhatIsABlurTakesNoMoreStepsThanAreSeenUnlessItIsThin)
{
    EXPECT_EQ(stepsOfSpinning(0.1, 100.0), 54);  // 0.08 rad in each
    EXPECT_EQ(stepsOfSpinning(0.1, 400.0), 80);
    const int steps = stepsOfSpinning(0.1, 2000.0);  // 0.64 rad in each
    EXPECT_GE(steps, 130);
    EXPECT_LE(steps, 134);

    EXPECT_EQ(stepsOfMeeting(Method::scree, Vec3::Ones(), 600.0), 50);
    EXPECT_EQ(stepsOfMeeting(Method::scree, Vec3::Ones(), 2000.0), 80);
    EXPECT_GE(stepsOfMeeting(Method::paper, Vec3::Ones(), 2000.0), 160);
    // Two thicknesses in each, as they do in sight.
    EXPECT_GE(stepsOfMeeting(Method::scree, {1.0, 0.02, 1.0}, 100.0), 104);
}

TEST(StepLimit, TheBodyThatIsNamedIsTheOneThatIsNoBlur)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const auto meet = [&](const Vec3& size, double speed, double aside) {
        const auto box = exactBox(size, 1);
        addBody(world, box, material, {Vec3(aside, 0.0, 0.0), Quat::Identity()});
        return addBody(world, box, material, {Vec3(aside, speed / 24.0, 0.0), Quat::Identity()},
                       1.0, {0.0, -speed, 0.0});
    };
    meet(Vec3::Ones(), 4000.0, 0.0);
    const BodyId thin = meet({1.0, 0.02, 1.0}, 100.0, 1000.0);
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    const FrameReport report = Stepper(settings).advanceFrame(world, 1.0 / 24.0);
    EXPECT_GE(report.steps, 104);
    EXPECT_LE(report.steps, 110);
    EXPECT_EQ(report.fastestBody, thin);
}

TEST(StepLimit, WhatIsThinOnlyAtItsEdgeMayPassMoreThanThatInAStep)
{
    const auto shapeOf = [](TriMesh mesh, const auto& changeHeight) {
        for (Eigen::Index v = 0; v < mesh.points.cols(); ++v)
            mesh.points(1, v) = changeHeight(Vec3(mesh.points.col(v)));
        ShapeSettings settings;
        settings.resolution = 48;
        return buildMeshShape("thing", mesh, settings);
    };
    const auto wedge = shapeOf(makeBox({1.0, 1.0, 1.0}, {32, 1, 8}),
                               [](const Vec3& p) { return p.y() * (0.01 + 0.99 * (p.x() + 0.5)); });
    EXPECT_LT(wedge->innerThickness, 0.05);
    EXPECT_EQ(thicknessForSteps(Method::paper, *wedge), wedge->innerThickness);
    EXPECT_GT(thicknessForSteps(Method::scree, *wedge), 2.0 * wedge->innerThickness);
    EXPECT_LE(thicknessForSteps(Method::scree, *wedge), 0.5 * wedge->innerBall.radius);

    const auto knobbed = shapeOf(makeBox({1.0, 0.02, 1.0}, {20, 1, 20}), [](const Vec3& p) {
        const bool isKnob = std::abs(p.x()) < 0.12 && std::abs(p.z()) < 0.12;
        return p.y() > 0.0 && isKnob ? 0.3 : p.y();
    });
    EXPECT_GT(knobbed->innerBall.radius, 0.05);
    EXPECT_NEAR(thicknessForSteps(Method::scree, *knobbed), 0.02, 1e-6);
}

TEST(StepLimit, WhatSleepsAsksForNoSteps)
{
    // Awake it asks for five: it may fall half its thickness in each.
    for (const bool onKeyedTable : {false, true}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        if (onKeyedTable) {
            addKeyedBody(world, boxShape({1.0, 0.2, 1.0}, 1), material,
                         {{0.0, {{0.0, -0.1, 0.0}, Quat::Identity()}}}, KeyInterpolation::smooth);
        } else {
            addPlane(world, material);
        }
        addBody(world, exactBox({0.09, 0.002, 0.06}, 1), material,
                {Vec3(0.0, 0.001, 0.0), Quat::Identity()});
        Stepper stepper(screeSettings());
        EXPECT_GE(stepper.advanceFrame(world, 1.0 / 24.0).steps, 5);
        for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        ASSERT_TRUE(world.contactMemory.isAsleep(1)) << onKeyedTable;
        const FrameReport report = stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_EQ(report.steps, 1) << onKeyedTable;
        EXPECT_EQ(report.fastestBody, -1) << onKeyedTable;
    }
}

/// Steps of a frame in which a wheel of so many sides rolls so fast, and how far it goes [m].
struct Rolled {
    int steps;
    double way;
};

Rolled rolled(int sides, double speed, Method method)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const double radius = 0.1;
    const Quat lying(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
    addBody(world, buildMeshShape("wheel", makeCylinder(radius, 0.1, sides, 1)), material,
            {Vec3(0.0, radius, 0.0), lying}, 1.0, {speed, 0.0, 0.0}, {0.0, 0.0, -speed / radius});
    StepSettings settings = experimentSettings();
    settings.method = method;
    const int steps = Stepper(settings).advanceFrame(world, 1.0 / 24.0).steps;
    return {steps, world.motion[1].position.x()};
}

TEST(StepLimit, AWheelRollsAsFastAsItMayInAsManySteps)
{
    // At 20 m/s it turns by 2 rad in each.
    for (const double speed : {0.5, 5.0, 20.0}) {
        const Rolled wheel = rolled(48, speed, Method::scree);
        EXPECT_EQ(wheel.steps, 4) << speed;
        EXPECT_NEAR(wheel.way, speed / 24.0, 1e-4 * speed / 24.0) << speed;
    }
    EXPECT_GT(rolled(12, 5.0, Method::scree).steps, 20);  // of corners
    EXPECT_GT(rolled(48, 5.0, Method::paper).steps, 12);
}

TEST(StepLimit, WhatRestsOnAFixedBodyFallsInAStepByNoMoreThanTheHoverLimit)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    const BodyId block =
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material, {Vec3(0, 0.5, 0), Quat::Identity()});
    StepSettings settings = experimentSettings();
    settings.method = Method::paper;
    const FrameReport report = Stepper(settings).advanceFrame(world, 1.0 / 24.0);
    const double fall = settings.hoverLimit * world.shapeOf(block).thickness();
    const double longest = std::sqrt(fall / settings.gravity.norm());  // g dt² = fall
    EXPECT_EQ(report.sum.limitedBy, StepLimit::hover);
    EXPECT_EQ(report.steps, std::ceil(1.0 / 24.0 / longest));
}

TEST(StepLimit, WhatFliesHighAboveTheGroundDoesNotShortenTheStepsOfAll)
{
    const auto stepsAt = [](double height) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addPlane(world, material);
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(0, height, 0), Quat::Identity()}, 1.0, {20.0, -20.0, 0.0}, {0.0, 22.0, 0.0});
        StepSettings settings = experimentSettings();
        settings.method = Method::scree;
        return Stepper(settings).advanceFrame(world, 1.0 / 24.0).steps;
    };
    EXPECT_GE(stepsAt(1.5), 12);
    EXPECT_LE(stepsAt(12.0), 4);
}

}  // namespace
}  // namespace scree::test
