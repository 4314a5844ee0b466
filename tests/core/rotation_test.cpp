// Our own sines and arcs against the C library's, and rotations against each other.
#include "core/math/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace scree {
namespace {

Vec3 drawn(std::uint64_t i, double size)
{
    const auto draw = [&](std::uint64_t k) { return 2.0 * randomUnit(11, i, k) - 1.0; };
    return size * Vec3(draw(0), draw(1), draw(2));
}

TEST(Rotation, SineAndCosineAreThoseOfTheLibraryToTheLastBitOrTwo)
{
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const double x = (i % 2 ? 10.0 : 1e6) * (2.0 * randomUnit(7, i) - 1.0);
        double sine = 0.0, cosine = 0.0;
        sinCos(x, sine, cosine);
        EXPECT_NEAR(sine, std::sin(x), 3e-16) << x;
        EXPECT_NEAR(cosine, std::cos(x), 3e-16) << x;
    }
}

TEST(Rotation, WhatIsNoNumberOfQuadrantsHasNeitherSineNorCosine)
{
    for (const double x : {double{NAN}, double{INFINITY}, double{-INFINITY}, 1e30}) {
        double sine = 0.0, cosine = 0.0;
        sinCos(x, sine, cosine);
        EXPECT_TRUE(std::isnan(sine)) << x;
        EXPECT_TRUE(std::isnan(cosine)) << x;
    }
}

TEST(Rotation, TheArcTangentIsThatOfTheLibraryToAFewBits)
{
    for (double x = 1e-9; x < 1e12; x *= 1.01) {
        EXPECT_NEAR(arcTangent(x), std::atan(x), 1e-15 * std::atan(x)) << x;
    }
    EXPECT_EQ(arcTangent(0.0), 0.0);
    EXPECT_EQ(arcTangent(INFINITY), kPi / 2.0);
}

TEST(Rotation, TheExponentialOfTheRotationVectorIsTheRotation)
{
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Vec3 v = drawn(i, std::pow(10.0, -static_cast<double>(i % 10)));
        EXPECT_LE((rotationVector(exponentialMap(v)) - v).norm(), 1e-15 + 4e-15 * v.norm()) << i;
        const Eigen::AngleAxisd turn(v.norm(), v.normalized());
        EXPECT_LE((exponentialMap(v).toRotationMatrix() - turn.toRotationMatrix()).norm(), 2e-15);
        // q and −q are the same rotation.
        Quat other = exponentialMap(v);
        other.coeffs() *= -1.0;
        EXPECT_LE((rotationVector(other) - v).norm(), 1e-15 + 4e-15 * v.norm()) << i;
    }
    EXPECT_NEAR(rotationVector(exponentialMap({0.0, 4.0, 0.0})).y(), 4.0 - 2.0 * kPi, 1e-15);
}

TEST(Rotation, ATurnIsInTheWorldsAxesAndKeepsTheLengthOfTheQuaternion)
{
    const Quat q = exponentialMap({0.3, -0.2, 0.9});
    const Vec3 turn(0.0, 0.7, 0.1), x(1.0, 2.0, -0.5);
    EXPECT_LE((rotated(q, turn) * x - exponentialMap(turn) * (q * x)).norm(), 1e-14);
    Quat often = q;
    for (int i = 0; i < 10000; ++i) often = rotated(often, turn);
    EXPECT_NEAR(often.norm(), 1.0, 4e-16);
}

TEST(Rotation, EulerAnglesTurnAboutXFirst)
{
    const Quat q = fromEulerXyz({kPi / 2.0, 0.0, kPi / 2.0});
    EXPECT_LE((q * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
    EXPECT_LE((q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Rotation, AnglesBetweenVectorsAreExactWhereACosineIsNot)
{
    EXPECT_NEAR(angleBetween({2.0, 0.0, 0.0}, {5.0, 5e-9, 0.0}), 1e-9, 1e-24);
    EXPECT_NEAR(angleBetween({1.0, 0.0, 0.0}, {0.0, 3.0, 0.0}), kPi / 2.0, 4e-16);
    EXPECT_EQ(angleBetween({1.0, 0.0, 0.0}, {-2.0, 0.0, 0.0}), kPi);
}

TEST(Rotation, SkewIsTheCrossProductAndInertiaTurnsWithTheBody)
{
    const Vec3 a(1.0, -2.0, 3.0), b(0.5, 4.0, -1.0);
    EXPECT_EQ(skew(a) * b, a.cross(b));
    const Mat3 turn = exponentialMap({0.0, 0.0, kPi / 2.0}).toRotationMatrix();
    const Mat3 inverse = inverseInertiaWorld(turn, {1.0, 2.0, 3.0});
    EXPECT_LE((inverse - Mat3(Vec3(2.0, 1.0, 3.0).asDiagonal())).norm(), 1e-15);
}

}  // namespace
}  // namespace scree
