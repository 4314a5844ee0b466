// Impulses whose result is known by heart. Laws for any pair: scree verify E15.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/impulse.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

TEST(Impulses, EqualSpheresHeadOnExchangeTheirVelocities)  // [A30]
{
    const Mat3 k = 2.0 * Mat3::Identity();  // 1 kg each, struck through their centres
    const Vec3 u(3.0, 0.0, 0.0), n(-1.0, 0.0, 0.0);
    EXPECT_LE((contactImpulse(k, u, n, 1.0, 0.5).impulse - Vec3(-3.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_LE((contactImpulse(k, u, n, 0.0, 0.5).impulse - Vec3(-1.5, 0.0, 0.0)).norm(), 1e-12);
}

TEST(Impulses, AnElasticBlowHeadOnIsANumberHoweverItIsRounded)  // [A33]
{
    for (int i = 1; i <= 20000; ++i) {
        const Mat3 k = (1.0 + 1.0 / i) * Mat3::Identity();
        const Vec3 u(0.0, -0.01 * i / 7.0, 0.0);
        const Vec3 j = contactImpulse(k, u, Vec3::UnitY(), 1.0, 0.5).impulse;
        ASSERT_LE((u + k * j + u).norm(), 1e-12 * u.norm()) << i;
    }
}

TEST(Impulses, AJammedRodIsNeitherPulledNorGivenEnergy)  // [A32, A33]
{
    // A rod at 60° pushed into a floor of friction 3: the sliding formula would divide by less than
    // zero.
    const Vec3 r = -0.5 * Vec3(std::cos(kPi / 3.0), std::sin(kPi / 3.0), 0.0);
    PassInertia rod{1.0, Mat3::Zero()};
    rod.inverseInertia = 12.0 * Mat3::Identity();
    const Mat3 k = collisionMatrix(rod, r);
    const Vec3 n = Vec3::UnitY(), u(-1.0, -0.2, 0.0);
    const ContactImpulse j = contactImpulse(k, u, n, 0.0, 3.0);
    EXPECT_GE(j.impulse.dot(n), 0.0);
    EXPECT_LE(workOf(j.impulse, k, u), 1e-15);
    EXPECT_NEAR((u + k * j.impulse).dot(n), 0.0, 1e-12);
}

TEST(Impulses, WhereNeitherStickingNorSlidingWillDoTheImpulseStaysInTheCone)  // [A33]
{
    // Slender bodies struck anywhere: as much of sticking is taken as the cone and the energy
    // allow.
    int blended = 0, atTheCone = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const auto draw = [&](std::uint64_t what) { return randomUnit(3, i, what); };
        const Vec3 r(draw(0) - 0.5, draw(1) - 0.5, draw(2) - 0.5);
        const Mat3 axes = exponentialMap(3.0 * Vec3(draw(3), draw(4), draw(5))).toRotationMatrix();
        const Vec3 inverseMoments(4.0, 4.0 + 120.0 * draw(6), 4.0 + 120.0 * draw(7));
        const Mat3 k = collisionMatrix({1.0, inverseInertiaWorld(axes, inverseMoments)}, r);
        const Vec3 n = Vec3::UnitY(), u(2.0 * draw(8) - 1.0, -0.5 * draw(9) - 0.01, draw(10) - 0.5);
        const double mu = 0.1 + 1.9 * draw(11), e = draw(12);

        const ContactImpulse j = contactImpulse(k, u, n, e, mu);
        const double normal = j.impulse.dot(n);
        const double tangential = (j.impulse - normal * n).norm();
        // Rounding of sums whose terms cancel to a hundredth.
        ASSERT_LE(tangential, mu * normal * (1.0 + 1e-12)) << i;
        ASSERT_LE(workOf(j.impulse, k, u), 1e-13) << i;
        ASSERT_NEAR((u + k * j.impulse).dot(n), -e * u.dot(n), 1e-12) << i;
        if (j.kind != FrictionCase::fallback) continue;
        ++blended;
        atTheCone += tangential > mu * normal * (1.0 - 1e-9);
    }
    EXPECT_GT(blended, 500);
    EXPECT_GT(atTheCone, 400);
}

TEST(Impulses, WithoutSlipAndFrictionEnoughTheContactSticks)  // [A31, A32]
{
    const Mat3 k = Mat3::Identity();
    const ContactImpulse j = contactImpulse(k, {0.3, -1.0, 0.0}, Vec3::UnitY(), 0.0, 0.5);
    EXPECT_EQ(j.kind, FrictionCase::sticking);
    EXPECT_LE((Vec3(0.3, -1.0, 0.0) + k * j.impulse).norm(), 1e-15);
    const ContactImpulse slipping = contactImpulse(k, {0.6, -1.0, 0.0}, Vec3::UnitY(), 0.0, 0.5);
    EXPECT_EQ(slipping.kind, FrictionCase::sliding);
    EXPECT_NEAR(slipping.impulse.x(), -0.5, 1e-15);
}

}  // namespace
}  // namespace scree
