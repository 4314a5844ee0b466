// Impulses whose result is known by heart. Laws for any pair: scree verify E15.
#include <gtest/gtest.h>

#include <cmath>

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
