// Experiments with round and flat meshes: E3 billiards, E5 see-saw, E16 bounce, E25 drop to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(E3Billiards, TheLastOfFiveTouchingMeshBallsLeavesWithTheWholeMomentum)
{
    World world;
    const MaterialId floor = addMaterial(world, 0.0, 0.0), balls = addMaterial(world, 0.0, 1.0);
    addPlane(world, floor);
    const auto ball = buildMeshShape("ball", makeSphere(1.0, 3));
    for (int i = 0; i < 5; ++i) {
        addBody(world, ball, balls, {{-4.0 + 2.0 * i, 1.0, 0.0}, Quat::Identity()});
    }
    addBody(world, ball, balls, {{-10.0, 1.0, 0.0}, Quat::Identity()}, 1.0, {20.0, 0.0, 0.0});
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 2 * 240; ++k) stepper.step(world, 1.0 / 240.0);
    double others = 0.0;
    for (BodyId b : {1, 2, 3, 4, 6}) others += std::abs(world.motion[b].velocity.x());
    EXPECT_GE(world.motion[5].velocity.x(), 19.0);
    EXPECT_LE(others, 1.0);
}

/// Tilt of the see-saw's plank, heavy side down positive [degrees], after each quarter second. The
/// pivot is a mesh of 64 sides where the experiment has a true cylinder.
std::vector<double> seeSaw(bool contact, int quarters)
{
    World world;
    const MaterialId rough = addMaterial(world, 1.0, 0.05),
                     plankMaterial = addMaterial(world, 0.0, 0.05);
    const MaterialId heavy = addMaterial(world, 0.15, 0.05), light = addMaterial(world, 0.3, 0.05);
    addPlane(world, rough);
    addBody(world, buildMeshShape("pivot", makeCylinder(0.5, 2.5, 64, 2)), rough,
            {{0.0, 0.5, 0.0}, exponentialMap({kPi / 2.0, 0.0, 0.0})}, 0.0);
    const BodyId plank =
        addBody(world, buildMeshShape("plank", makeBox({10.0, 0.5, 2.0}, {40, 2, 8})),
                plankMaterial, {{0.0, 1.25, 0.0}, Quat::Identity()}, 10.0);
    addBody(world, boxShape(Vec3::Constant(1.8), 2), heavy, {{3.5, 2.4, 0.0}, Quat::Identity()},
            20.0);
    addBody(world, boxShape(Vec3::Ones(), 2), light, {{-4.0, 2.0, 0.0}, Quat::Identity()}, 5.0);
    StepSettings settings = experimentSettings();
    if (!contact) settings.contactIterations = 0;
    Stepper stepper(settings);
    std::vector<double> tilts;
    for (int k = 1; k <= 60 * quarters; ++k) {
        stepper.step(world, 1.0 / 240.0);
        if (k % 60) continue;
        const Vec3 along = world.worldFromAsset(plank).orientation * Vec3::UnitX();
        tilts.push_back(-std::asin(along.y()) * 180.0 / kPi);
    }
    return tilts;
}

TEST(E5SeeSaw, WeightIsFeltThroughThePlank)
{
    const std::vector<double> tilt = seeSaw(true, 24);
    EXPECT_NEAR(tilt[0], 1.887, 0.05 * 1.887);
    EXPECT_NEAR(tilt[1], 7.547, 0.05 * 7.547);
    EXPECT_NEAR(tilt[7], 11.54, 0.2);    // rests on the floor, heavy side down
    EXPECT_NEAR(tilt[23], -11.54, 0.2);  // the heavy block has slid off, the light side is down
}

TEST(E5SeeSaw, ShockPropagationAloneMakesBodiesWeightless)
{
    EXPECT_LE(std::abs(seeSaw(false, 4)[3]), 0.1);
}

TEST(E16Bounce, AnElasticBallLosesNoMoreHeightThanAStepOfItsFall)
{
    for (double rate : {240.0, 960.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.0, 1.0);
        addPlane(world, material);
        const BodyId ball = addBody(world, buildMeshShape("ball", makeSphere(0.5, 3)), material,
                                    {{0.0, 5.5, 0.0}, Quat::Identity()});
        Stepper stepper(experimentSettings());
        const double allowed = 1.1 * std::sqrt(2.0 * 9.8 * 5.0) / rate;
        double speed = 0.0, apex = 5.0;
        int bounces = 0;
        while (bounces < 3) {
            stepper.step(world, 1.0 / rate);
            const double now = world.motion[ball].velocity.y();
            if (speed > 0.0 && now <= 0.0) {
                const double height = world.motion[ball].position.y() - 0.5;
                EXPECT_GE(height, apex - allowed) << rate << " Hz, bounce " << bounces;
                EXPECT_LE(height, apex);
                apex = height;
                ++bounces;
            }
            speed = now;
        }
    }
}

TEST(E25DropToRest, WithAllDefaultsEachShapeComesToRestOnTheFloor)
{
    struct Case {
        const char* name;
        std::shared_ptr<const Shape> shape;
        Vec3 turn;
    };
    for (const Case& c :
         {Case{"cube", boxShape(Vec3::Ones(), 2), {0.4, 0.2, 0.3}},
          Case{"ring", buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10})), {0.3, 0.0, 0.2}},
          Case{"block of twelve triangles", boxShape({1.0, 0.4, 0.7}, 1), {0.7, 0.1, 0.4}}}) {
        SCOPED_TRACE(c.name);
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.2);
        addPlane(world, material);
        const BodyId body =
            addBody(world, c.shape, material, {Vec3::Zero(), exponentialMap(c.turn)});
        const auto lowest = [&] {
            double low = 1e300;
            for (Eigen::Index v = 0; v < c.shape->mesh.points.cols(); ++v) {
                const Vec3 p = c.shape->mesh.points.col(v);
                low = std::min(low, (world.motion[body].worldFromBody() * p).y());
            }
            return low;
        };
        world.motion[body].position.y() += 0.5 - lowest();
        Stepper stepper(experimentSettings());
        for (int frame = 0; frame < 3 * 24; ++frame) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_LE(world.motion[body].velocity.norm(), 1e-6);
        EXPECT_LE(angularVelocityOf(world, body).norm(), 1e-6);
        EXPECT_LE(std::abs(lowest()), 1e-3 * c.shape->box.longestEdge());
    }
}

}  // namespace
}  // namespace scree::test
