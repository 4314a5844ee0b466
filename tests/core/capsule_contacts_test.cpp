// Capsules touch each other, balls and planes as their axes tell.  [A9]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/lying_capsule.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kRadius = 0.2, kHalf = 0.5;

std::shared_ptr<const Shape> capsule()
{
    static const auto shape = buildMeshShape("capsule", makeCapsule(kRadius, 2.0 * kHalf, 20, 5));
    return shape;
}

Pose lyingAt(const Vec3& position, const Vec3& direction)
{
    return lyingAlong(*capsule(), position, direction);
}

struct Found {
    std::vector<GapContact> contacts;
    double apart;
};

Found findBetween(const Shape& a, const Pose& worldFromA, const Shape& b, const Pose& worldFromB,
                  double reach)
{
    Found found;
    found.apart =
        NearFeatures().findContacts({&a, &b, worldFromA, worldFromB}, reach, found.contacts);
    return found;
}

TEST(CapsuleContacts, ThoseThatLieAlongEachOtherTouchWhereTheirSharedLengthEnds)
{
    const Pose below = lyingAt(Vec3::Zero(), Vec3::UnitX());
    // Shifted along by half a length, and turned by little or nothing; the gap is a millimetre.
    for (const double turn : {0.0, 1e-9, 1e-5, -1e-4}) {
        const Vec3 along(std::cos(turn), 0.0, std::sin(turn));
        const Pose above = lyingAt({kHalf, 2.0 * kRadius + 1e-3, 0.0}, along);
        const Found found = findBetween(*capsule(), above, *capsule(), below, 2e-3);
        ASSERT_EQ(found.contacts.size(), 2u) << turn;
        EXPECT_NEAR(found.apart, 1e-3, 1e-7) << turn;
        double least = kHalf, most = 0.0;
        for (const GapContact& contact : found.contacts) {
            EXPECT_NEAR(contact.gap, 1e-3, 1e-7) << turn;
            EXPECT_NEAR(contact.normal.y(), 1.0, 1e-6) << turn;
            const double x = above.position.x() + contact.rA.x();
            least = std::min(least, x);
            most = std::max(most, x);
        }
        EXPECT_NEAR(least, 0.0, 1e-6) << turn;
        EXPECT_NEAR(most, kHalf, 1e-6) << turn;
    }
}

TEST(CapsuleContacts, OneThatLiesInTheGrooveOfTwoOthersStaysThere)
{
    World world;
    const MaterialId material = addMaterial(world, 0.0, 0.0);
    const auto add = [&](const Vec3& position, double mass) {
        return addBody(world, capsule(), material,
                       lyingAt(position, Vec3::UnitX()) * capsule()->bodyFromAsset, mass);
    };
    for (const double z : {-0.25, 0.25}) add({0.0, 0.0, z}, 0.0);
    const double height = std::sqrt(4.0 * kRadius * kRadius - 0.25 * 0.25);
    const BodyId above = add({0.3, height + 1e-3, 0.0}, 1.0);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    const BodyMotion& motion = world.motion[above];
    EXPECT_LT((motion.position - Vec3(0.3, height, 0.0)).norm(), 2e-5 * height);
    const Vec3 axis = motion.orientation * capsule()->capsule.half / kHalf;
    EXPECT_NEAR(std::abs(axis.x()), 1.0, 1e-9);
    EXPECT_TRUE(motion.velocity.isZero(0.0)) << motion.velocity.transpose();
}

TEST(CapsuleContacts, OnAPlaneBothEndsTouch)
{
    const auto plane = buildPlaneShape("plane");
    const Pose origin{Vec3::Zero(), Quat::Identity()};
    // One end a millimetre inside, the other as much above.
    const double slope = 1e-3 / kHalf;
    const Pose pose = lyingAt({0.0, kRadius, 0.0}, {std::sqrt(1.0 - slope * slope), slope, 0.0});
    for (const bool planeIsA : {false, true}) {
        const Found found = planeIsA ? findBetween(*plane, origin, *capsule(), pose, 2e-3)
                                     : findBetween(*capsule(), pose, *plane, origin, 2e-3);
        ASSERT_EQ(found.contacts.size(), 2u);
        EXPECT_NEAR(found.apart, -1e-3, 1e-6);
        std::vector<double> gaps{found.contacts[0].gap, found.contacts[1].gap};
        std::ranges::sort(gaps);
        EXPECT_NEAR(gaps[0], -1e-3, 1e-6);
        EXPECT_NEAR(gaps[1], 1e-3, 1e-6);
        EXPECT_NEAR(found.contacts[0].normal.y(), planeIsA ? -1.0 : 1.0, 1e-12);
        // Nearer than both there is nothing.
        EXPECT_TRUE(findBetween(*capsule(), pose, *plane, origin, -1.1e-3).contacts.empty());
    }
}

TEST(CapsuleContacts, ThoseWhoseAxesCrossAreLedApartAcrossBoth)
{
    const Pose one = lyingAt(Vec3::Zero(), Vec3::UnitX());
    const Found crossed =
        findBetween(*capsule(), one, *capsule(), lyingAt(Vec3::Zero(), Vec3::UnitZ()), 0.0);
    ASSERT_FALSE(crossed.contacts.empty());
    const GapContact& deepest = *std::ranges::min_element(crossed.contacts, {}, &GapContact::gap);
    EXPECT_NEAR(std::abs(deepest.normal.y()), 1.0, 1e-9);
    EXPECT_NEAR(deepest.gap, -2.0 * kRadius, 1e-9);
    // In one and the same place any way across will do.
    const Found same = findBetween(*capsule(), one, *capsule(), one, 0.0);
    ASSERT_FALSE(same.contacts.empty());
    for (const GapContact& contact : same.contacts) {
        EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
        EXPECT_NEAR(contact.normal.x(), 0.0, 1e-9);
    }
}

/// What is told of the distance must hold however the two turn: nobody asks again before they have
/// moved as far.
TEST(CapsuleContacts, NoneIsNearerThanTheyAreSaidToBeApart)
{
    int met = 0;
    for (std::uint64_t draw = 0; draw < 300; ++draw) {
        const auto drawn = [&](std::uint64_t k) -> Vec3 {
            return Vec3(randomUnit(7, draw, k), randomUnit(7, draw, k + 1),
                        randomUnit(7, draw, k + 2)) -
                   Vec3::Constant(0.5);
        };
        const Pose a = lyingAt(2.0 * drawn(0), drawn(3).normalized());
        const Pose b = lyingAt(Vec3::Zero(), drawn(6).normalized());
        const double apart = findBetween(*capsule(), a, *capsule(), b, 10.0).apart;
        met += apart < 0.0;
        const auto seen = [&](double reach) {
            return !findBetween(*capsule(), a, *capsule(), b, reach).contacts.empty();
        };
        EXPECT_FALSE(seen(apart - 1e-9)) << draw;
        EXPECT_TRUE(seen(apart + 1e-9)) << draw;
    }
    EXPECT_GE(met, 50);
    EXPECT_LE(met, 250);
}

}  // namespace
}  // namespace scree::test
