// E15: impulses obey Newton, Coulomb and the conservation laws for any pair.  [A29–A35]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree {
namespace {

/// Draws named by what they are for, so that a case can be looked at alone.
class Draw {
public:
    explicit Draw(std::uint64_t sample) : sample_(sample) {}
    double between(double low, double high)
    {
        return low + (high - low) * randomUnit(15, sample_, next_++);
    }
    double logarithmic(double low, double high)
    {
        return std::exp(between(std::log(low), std::log(high)));
    }
    Vec3 vector(double size)
    {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
    Vec3 direction()
    {
        Vec3 v = vector(1.0);
        while (v.norm() < 0.1) v = vector(1.0);
        return v.normalized();
    }

private:
    std::uint64_t sample_, next_ = 0;
};

struct RandomBody {
    BodyMotion motion;
    BodyMass mass;
    PassInertia inertia;
    Vec3 r;
};

RandomBody randomBody(Draw& draw, double mass)
{
    RandomBody body;
    body.motion.orientation = exponentialMap(draw.vector(3.0));
    body.motion.velocity = draw.vector(2.0);
    body.r = draw.vector(1.0);
    if (mass > 0.0) {
        body.mass.inverseMass = 1.0 / mass;
        body.mass.inverseInertia = {draw.between(1.0, 9.0) / mass, draw.between(1.0, 9.0) / mass,
                                    draw.between(1.0, 9.0) / mass};
        body.motion.angularMomentum = mass * draw.vector(0.5);
    }
    body.inertia = passInertia(body.mass, body.motion.orientation);
    return body;
}

TEST(E15Impulses, AHundredThousandRandomPairsObeyEveryLaw)
{
    std::int64_t fallbacks = 0;
    double worstNormal = 0.0, worstCone = 0.0, worstWork = 0.0, worstMomentum = 0.0;
    for (std::uint64_t sample = 0; sample < 100000; ++sample) {
        Draw draw(sample);
        const double massA = draw.logarithmic(1e-3, 1e3);
        const double massB = draw.between(0.0, 1.0) < 0.2 ? 0.0 : draw.logarithmic(1e-3, 1e3);
        RandomBody a = randomBody(draw, massA), b = randomBody(draw, massB);
        const double e = draw.between(-1.0, 1.0), mu = draw.between(0.0, 5.0);
        const Vec3 u = pointVelocity(a.motion, a.inertia.inverseInertia, a.r) -
                       pointVelocity(b.motion, b.inertia.inverseInertia, b.r);
        Vec3 n = draw.direction();
        if (u.dot(n) > 0.0) n = -n;
        const Mat3 k = collisionMatrix(a.inertia, a.r) + collisionMatrix(b.inertia, b.r);
        const ContactImpulse j = contactImpulse(k, u, n, e, mu);
        fallbacks += j.kind == FrictionCase::fallback;

        const double energyBefore =
            kineticEnergy(a.motion, a.mass) + kineticEnergy(b.motion, b.mass);
        const Vec3 pA = massA * a.motion.velocity, pB = massB * b.motion.velocity;
        applyImpulse(a.motion, a.inertia, a.r, j.impulse);
        applyImpulse(b.motion, b.inertia, b.r, -j.impulse);
        const Vec3 uAfter = pointVelocity(a.motion, a.inertia.inverseInertia, a.r) -
                            pointVelocity(b.motion, b.inertia.inverseInertia, b.r);

        const double normal = j.impulse.dot(n);
        ASSERT_GE(normal, 0.0) << "pull in sample " << sample;
        const double scale = u.norm();
        worstNormal = std::max(worstNormal, std::abs(uAfter.dot(n) + e * u.dot(n)) / scale);
        worstCone = std::max(worstCone, (j.impulse - normal * n).norm() / (mu * normal + 1e-300));
        worstWork = std::max(worstWork, workOf(j.impulse, k, u) / (energyBefore + 1e-300));
        if (massB > 0.0) {
            const Vec3 after = massA * a.motion.velocity + massB * b.motion.velocity;
            worstMomentum = std::max(worstMomentum, (after - pA - pB).norm() /
                                                        (pA.norm() + pB.norm() + j.impulse.norm()));
        }
    }
    EXPECT_LE(worstNormal, 1e-9);
    EXPECT_LE(worstCone, 1.0 + 1e-12);
    EXPECT_LE(worstWork, 1e-12);
    EXPECT_LE(worstMomentum, 1e-13);
    EXPECT_GE(fallbacks, 100);
}

TEST(E15Impulses, EqualSpheresHeadOnExchangeTheirVelocities)
{
    const Mat3 k = 2.0 * Mat3::Identity();  // 1 kg each, struck through their centres
    const Vec3 u(3.0, 0.0, 0.0), n(-1.0, 0.0, 0.0);
    EXPECT_LE((contactImpulse(k, u, n, 1.0, 0.5).impulse - Vec3(-3.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_LE((contactImpulse(k, u, n, 0.0, 0.5).impulse - Vec3(-1.5, 0.0, 0.0)).norm(), 1e-12);
}

TEST(E15Impulses, AJammedRodIsNeitherPulledNorGivenEnergy)
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

TEST(E15Impulses, WithoutSlipAndFrictionEnoughTheContactSticks)
{
    const Mat3 k = Mat3::Identity();
    const ContactImpulse j = contactImpulse(k, {0.3, -1.0, 0.0}, Vec3::UnitY(), 0.0, 0.5);
    EXPECT_EQ(j.kind, FrictionCase::sticking);
    EXPECT_LE((Vec3(0.3, -1.0, 0.0) + k * j.impulse).norm(), 1e-15);
    const ContactImpulse slipping = contactImpulse(k, {0.6, -1.0, 0.0}, Vec3::UnitY(), 0.0, 0.5);
    EXPECT_EQ(slipping.kind, FrictionCase::sliding);
    EXPECT_NEAR(slipping.impulse.x(), -0.5, 1e-15);
}

/// Two balls of 1 kg run into a third between them, 2 m/s each; outgoing speeds of the outer two.
std::array<double, 2> tripleCollision(std::uint64_t seed, Vec3& momentum)
{
    static const auto ball = buildMeshShape("ball", makeSphere(0.5, 2));
    World world;
    const MaterialId material = test::addMaterial(world, 0.0, 0.8);
    StepSettings settings = test::experimentSettings();
    settings.gravity.setZero();
    settings.seed = seed;
    test::addBody(world, ball, material, {{-1.1, 0.0, 0.0}, Quat::Identity()}, 1.0,
                  {2.0, 0.0, 0.0});
    test::addBody(world, ball, material, {{0.0, 0.0, 0.0}, Quat::Identity()});
    test::addBody(world, ball, material, {{1.1, 0.0, 0.0}, Quat::Identity()}, 1.0,
                  {-2.0, 0.0, 0.0});
    Stepper stepper(settings);
    for (int k = 0; k < 60; ++k) stepper.step(world, 1.0 / 240.0);
    momentum = world.motion[0].velocity + world.motion[1].velocity + world.motion[2].velocity;
    return {world.motion[0].velocity.norm(), world.motion[2].velocity.norm()};
}

TEST(E15Impulses, ASymmetricTripleCollisionIsSymmetricOverTheSeeds)
{
    double left = 0.0, right = 0.0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Vec3 momentum;
        const auto [l, r] = tripleCollision(seed, momentum);
        left += l;
        right += r;
        EXPECT_LE(momentum.norm(), 1e-12);
    }
    EXPECT_GT(left, 10.0);
    EXPECT_LE(std::abs(left - right), 0.02 * 0.5 * (left + right));
}

TEST(E15Impulses, MirrorImagesGiveMirrorImages)
{
    for (std::uint64_t sample = 0; sample < 1000; ++sample) {
        Draw draw(sample + 500000);
        const Mat3 root = Mat3::NullaryExpr([&] { return draw.between(-1.0, 1.0); });
        const Mat3 k = root * root.transpose() + 0.1 * Mat3::Identity();
        const Mat3 mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
        const Vec3 u = draw.vector(2.0);
        Vec3 n = draw.direction();
        if (u.dot(n) > 0.0) n = -n;
        const double e = draw.between(0.0, 1.0), mu = draw.between(0.0, 2.0);
        const Vec3 image =
            contactImpulse(mirror * k * mirror, mirror * u, mirror * n, e, mu).impulse;
        const Vec3 original = contactImpulse(k, u, n, e, mu).impulse;
        EXPECT_LE((mirror * image - original).norm(), 1e-12 * (1.0 + original.norm()));
    }
}

}  // namespace
}  // namespace scree
