// What method `scree` does not look for, and need not: contacts that go along with slow bodies, and
// what lies beyond the way of bodies that fall side by side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/collision/near_features.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/gaps/gap_lag.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Two bodies, and what is known of them.
struct Followed {
    World world;
    GapScratch scratch;
    NearPair pair;

    Followed(const std::shared_ptr<const Shape>& a, const Pose& poseOfA,
             const std::shared_ptr<const Shape>& b, const Pose& poseOfB, double reach)
    {
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addBody(world, a, material, poseOfA);
        addBody(world, b, material, poseOfB);
        pair.bodies = {0, 1};
        pair.contacts = found(reach);
        pair.foundWithin = reach;
        followBodies(world, scratch);
    }

    std::vector<GapContact> found(double reach) const
    {
        std::vector<GapContact> contacts;
        NearFeatures().findContacts(placePair(world, pair.bodies), reach, contacts);
        return contacts;
    }

    /// Both move by random steps of about `size`, and the contacts go along.
    bool goOn(std::uint64_t run, std::uint64_t step, double size, double least)
    {
        for (const std::uint64_t body : {0u, 1u}) {
            BodyMotion& motion = world.motion[body];
            motion.position += size * signedUnits(run, 100 * step + 10 * body);
            motion.orientation =
                rotated(motion.orientation, size * signedUnits(run, 100 * step + 10 * body + 5));
        }
        followBodies(world, scratch);
        return takeContactsAlong(world, scratch, least, pair);
    }
};

/// Of the contacts that were taken along how far the same ones lie elsewhere when they are sought
/// anew; those that are found or lost on the way are left out.
struct Error {
    double gap = 0.0, place = 0.0, normal = 0.0;
    int contacts = 0;

    /// After three small steps; false when the contacts have not gone along.
    bool addWalk(std::uint64_t run, Followed& followed)
    {
        for (std::uint64_t step = 1; step <= 3; ++step)
            if (!followed.goOn(run, step, 3e-5, 0.0)) return false;
        const std::vector<GapContact> anew = followed.found(0.02);
        for (const GapContact& taken : followed.pair.contacts) {
            const auto same = std::ranges::find(anew, taken.feature, &GapContact::feature);
            if (same == anew.end()) continue;
            ++contacts;
            gap = std::max(gap, std::abs(taken.gap - same->gap));
            place = std::max(place, (taken.rA - same->rA).norm());
            normal = std::max(normal, (taken.normal - same->normal).norm());
        }
        return true;
    }
};

TEST(GapLag, WhatFallsSideBySideStaysAsFarApartAsItWas)
{
    const auto cube = boxShape(Vec3::Ones(), 1);
    const Pose a{Vec3(1.5, 0.0, 0.0), Quat::Identity()}, b{Vec3::Zero(), Quat::Identity()};
    Followed followed(cube, a, cube, b, 0.1);
    seeApart(followed.world, followed.scratch, 0.5, followed.pair);
    const auto apart = [&] {
        return apartAtLeast(followed.world, followed.scratch, followed.pair);
    };
    for (int step = 0; step < 100; ++step) {
        for (BodyMotion& motion : followed.world.motion) motion.position.y() -= 0.1;
        followBodies(followed.world, followed.scratch);
    }
    EXPECT_NEAR(apart(), 0.5, 1e-12);
    followed.world.motion[0].position.x() -= 0.125;
    followBodies(followed.world, followed.scratch);
    EXPECT_NEAR(apart(), 0.375, 1e-12);
    followed.world.motion[1].orientation = exponentialMap(Vec3(0.0, 0.1, 0.0));
    followBodies(followed.world, followed.scratch);
    EXPECT_NEAR(apart(), 0.375 - 0.1 * cube->boundingRadius, 1e-4);
}

TEST(GapLag, CornersOverFacesGoToWhereTheyWouldBeFound)
{
    const auto cube = boxShape(Vec3::Ones(), 1), slab = boxShape({4.0, 1.0, 4.0}, 1);
    Error error;
    for (std::uint64_t run = 0; run < 40; ++run) {
        const Pose tilted{
            Vec3(0.0, 1.003, 0.0) + 0.3 * signedUnits(run, 0).cwiseProduct(Vec3(1.0, 0.0, 1.0)),
            exponentialMap(0.002 * signedUnits(run, 3))};
        const Pose below{Vec3::Zero(), Quat::Identity()};
        const bool isAbove = run % 2 == 0;
        Followed followed(isAbove ? cube : slab, isAbove ? tilted : below, isAbove ? slab : cube,
                          isAbove ? below : tilted, 0.02);
        ASSERT_TRUE(error.addWalk(run, followed));
    }
    EXPECT_GE(error.contacts, 100);
    EXPECT_LE(error.gap, 1e-12);
    EXPECT_LE(error.place, 1e-12);
    EXPECT_LE(error.normal, 1e-12);
}

TEST(GapLag, CrossedEdgesGoNearlyThere)
{
    const auto bar = boxShape({4.0, 0.5, 0.5}, 1);
    Error error;
    for (std::uint64_t run = 0; run < 40; ++run) {
        const double edge = 0.25 * std::sqrt(2.0), angle = 0.25 * kPi;
        const Quat onEdge = exponentialMap(Vec3(angle, 0.0, 0.0));
        const Pose above{
            Vec3(0.0, 2.0 * edge + 0.003, 0.0) + 1e-3 * signedUnits(run, 0),
            exponentialMap(Vec3(0.0, 0.5 * kPi + 0.3 * signedUnit(run, 3), 0.0)) * onEdge};
        Followed followed(bar, above, bar, {Vec3::Zero(), onEdge}, 0.02);
        ASSERT_TRUE(error.addWalk(run, followed));
    }
    EXPECT_GE(error.contacts, 40);
    EXPECT_LE(error.gap, 1e-6);
    EXPECT_LE(error.place, 5e-3);
    EXPECT_LE(error.normal, 1e-3);
}

TEST(GapLag, WhatMovesFarOrMayHaveComeNearIsSoughtAnew)
{
    const auto cube = boxShape(Vec3::Ones(), 1), slab = boxShape({4.0, 1.0, 4.0}, 1);
    const Pose above{Vec3(0.0, 1.003, 0.0), Quat::Identity()};
    const auto followed = [&] { return Followed(cube, above, slab, Pose{}, 0.02); };
    EXPECT_TRUE(followed().goOn(0, 1, 3e-5, 0.019));
    EXPECT_FALSE(followed().goOn(0, 1, 3e-5, 0.02));
    EXPECT_FALSE(followed().goOn(0, 1, 4e-3, 0.0));
    // Each step takes of what is known.
    Followed slow = followed();
    int steps = 0;
    while (steps < 100 && slow.goOn(0, static_cast<std::uint64_t>(steps), 3e-5, 0.018)) ++steps;
    EXPECT_GE(steps, 2);
    EXPECT_LE(steps, 20);
}

TEST(GapLag, WhatTouchesRoundGoesAlongWithNobody)
{
    const auto ball = exactSphere(0.5);
    const Pose above{Vec3(0.0, 1.001, 0.0), Quat::Identity()};
    Followed followed(ball, above, ball, Pose{}, 0.02);
    ASSERT_EQ(followed.pair.contacts.size(), 1u);
    EXPECT_FALSE(followed.goOn(0, 1, 3e-5, 0.0));
}

/// Rings that tumble onto each other, and a stop wherever one is possible: each sitting knows
/// nothing but the world.
TEST(GapLag, ARunThatIsStoppedWhereverItMayBeGoesOnToTheSameBits)
{
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    World unbroken;
    const MaterialId material = addMaterial(unbroken, 0.5, 0.2);
    addPlane(unbroken, material);
    for (std::uint64_t i = 0; i < 9; ++i) {
        addBody(unbroken, ring, material,
                {Vec3(0.3 * signedUnit(i, 0), 1.5 + 0.9 * static_cast<double>(i),
                      0.3 * signedUnit(i, 1)),
                 exponentialMap(signedUnits(i, 2))},
                1.0, {0.0, -14.0, 0.0}, 12.0 * signedUnits(i, 5));
    }
    World broken = unbroken;
    constexpr int kFrames = 60;
    Stepper stepper(screeSettings());
    int steps = 0, stops = 0;
    for (int f = 0; f < kFrames; ++f) steps += stepper.advanceFrame(unbroken, 1.0 / 24.0).steps;
    while (broken.clock.frame < kFrames)
        stops += !Stepper(screeSettings())
                      .advanceFrame(broken, 1.0 / 24.0, [] { return true; })
                      .finished;
    EXPECT_GT(steps, 4 * kFrames);
    EXPECT_GT(stops, 4);
    EXPECT_EQ(stateHash(broken), stateHash(unbroken));
}

/// Eight blocks fall one above the other. Where the lowest is stopped within the step so are those
/// above it, one after the other.
TEST(GapLag, WhatFallsSideBySideIsStoppedByWhatIsStopped)
{
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.0);
    addPlane(world, material);
    const auto block = boxShape(Vec3::Ones(), 1);
    for (int i = 0; i < 8; ++i) {
        addBody(world, block, material, {Vec3(0.0, 0.502 + 1.004 * i, 0.0), Quat::Identity()}, 1.0,
                {0.0, -2.0, 0.0});
    }
    Stepper(screeSettings()).step(world, 1.0 / 96.0);
    double last = -0.5;
    for (BodyId b = 1; b <= 8; ++b) {
        const double height = world.motion[b].position.y();
        EXPECT_GE(height, last + 1.0 - 1e-3) << b;
        last = height;
    }
    EXPECT_LT(world.motion[8].position.y(), 0.502 + 1.004 * 7 - 0.01);  // those above still fall
}

}  // namespace
}  // namespace scree::test
