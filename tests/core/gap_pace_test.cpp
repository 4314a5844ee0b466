// How far bodies are looked for: no less than what may meet can come, and not much more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/gaps/gap_pace.h"
#include "core/geometry/primitives.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Two bodies side by side.
World twoBodies(const std::shared_ptr<const Shape>& a, const std::shared_ptr<const Shape>& b,
                const Vec3& bFromA)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addBody(world, a, material, {Vec3::Zero(), Quat::Identity()});
    addBody(world, b, material, {bFromA, Quat::Identity()});
    return world;
}

constexpr BodyPair kBoth = {0, 1};

TEST(GapPace, NoPointThatMayMeetTheOtherBodyComesFartherThanIsLookedFor)
{
    const auto cube = boxShape(Vec3::Constant(0.6), 1), egg = boxShape({0.2, 0.3, 1.4}, 1);
    int met = 0;
    double closest = 0.0;
    for (std::uint64_t run = 0; run < 400; ++run) {
        const World world = twoBodies(cube, egg, 1.2 * signedUnits(run, 0));
        const RigidMotion ofA{0.1 * signedUnits(run, 10), 0.2 * signedUnits(run, 20)};
        const RigidMotion ofB{0.1 * signedUnits(run, 30), 0.2 * signedUnits(run, 40)};
        const double told = farthestApproach(world, kBoth, ofA, ofB);
        const Vec3 xA = world.motion[0].position, xB = world.motion[1].position;
        for (std::uint64_t draw = 0; draw < 2000; ++draw) {
            const Vec3 place = xA + signedUnits(run, 1000 + 10 * draw);
            if ((place - xA).norm() > world.shapeOf(0).boundingRadius ||
                (place - xB).norm() > world.shapeOf(1).boundingRadius) {
                continue;
            }
            ++met;
            const Vec3 way =
                ofA.shift + ofA.turn.cross(place - xA) - ofB.shift - ofB.turn.cross(place - xB);
            ASSERT_LE(way.norm(), told * (1.0 + 1e-12)) << run;
            closest = std::max(closest, way.norm() / told);
        }
    }
    EXPECT_GT(met, 5000);
    EXPECT_GT(closest, 0.9);
}

TEST(GapPace, CogsThatRollOnEachOtherAreHardlyLookedFor)
{
    const double radius = 0.5, turn = 0.1;
    const auto wheel = boxShape(Vec3::Constant(2.0 * radius / std::sqrt(3.0)), 1);
    const World world = twoBodies(wheel, wheel, {2.0 * radius, 0.0, 0.0});
    const RigidMotion ofA{Vec3::Zero(), {0.0, 0.0, turn}}, ofB{Vec3::Zero(), {0.0, 0.0, -turn}};
    // Their surfaces go the same way where they touch; the sum of both spins is 0.1 m.
    EXPECT_LT(farthestApproach(world, kBoth, ofA, ofB), 0.07);
    EXPECT_NEAR(farthestApproach(world, kBoth, ofA, ofA), 2.0 * radius * turn, 1e-12);
}

TEST(GapPace, WhatIsRoundComesNoNearerByTurningInItself)
{
    const double radius = 0.5, height = 0.4, turn = 0.1;
    const auto wheel = buildMeshShape("wheel", makeCylinder(radius, height, 48, 1));
    const RigidMotion still{Vec3::Zero(), Vec3::Zero()};
    const RigidMotion rolling{Vec3::Zero(), turn * Vec3::UnitY()};
    const RigidMotion tumbling{Vec3::Zero(), turn * Vec3::UnitX()};
    World onGround;
    const MaterialId material = addMaterial(onGround, 0.5, 0.0);
    addBody(onGround, wheel, material, {Vec3(0.0, radius, 0.0), Quat::Identity()});
    addPlane(onGround, material);
    for (const World& world :
         {twoBodies(wheel, exactSphere(radius), {2.0 * radius, 0.0, 0.0}), onGround}) {
        EXPECT_LT(farthestApproach(world, kBoth, rolling, still), 1e-12);
        EXPECT_GT(farthestApproach(world, kBoth, tumbling, still), 0.5 * radius * turn);
    }
    const World balls = twoBodies(exactSphere(radius), wheel, {2.0 * radius, 0.0, 0.0});
    EXPECT_EQ(farthestApproach(balls, kBoth, tumbling, still), 0.0);
}

TEST(GapPace, OfAPlaneThatTurnsWhatIsNearTheBodyCounts)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addBody(world, exactSphere(0.5), material, {Vec3(10.0, 0.5, 0.0), Quat::Identity()});
    const RigidMotion still{Vec3::Zero(), Vec3::Zero()};
    const RigidMotion tilting{Vec3::Zero(), {0.0, 0.0, 0.01}};
    EXPECT_EQ(farthestApproach(world, kBoth, still, still), 0.0);
    EXPECT_GE(farthestApproach(world, kBoth, tilting, still), 0.1);
}

}  // namespace
}  // namespace scree::test
