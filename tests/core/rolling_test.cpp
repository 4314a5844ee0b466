// E9: rolling and spinning friction; E3: billiard balls that roll. [GBF03 “Rolling and Spinning
// Friction”, figure 5], [A40, A49–A51]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/rolling_friction.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/geometry/surface_curvature.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kRate = 240.0;  // steps a second

MaterialId addRollingMaterial(World& world, double friction, const RollingFriction& rolling,
                              double restitution = 0.0)
{
    return world.addMaterial({"round", 1.0, friction, restitution, rolling});
}

std::shared_ptr<const Shape> meshSphere()
{
    static const auto shape = buildMeshShape("sphere", makeSphere(0.5, 3));
    return shape;
}

struct Roll {
    double rollStop = 1e300, spinStop = 1e300;  ///< first time at rest [s]
    double distance = 0.0, speed = 0.0;         ///< at the end
    double reversal = 0.0;                      ///< largest rate against the first sense [rad/s]
    double energyRise = 0.0;                    ///< largest in a step [J]
    ImpulseCounts impulses;
};

/// A 2 kg ball of 0.5 m rolls at 2 m/s along +x and spins at 3 rad/s about the normal, for
/// `seconds`.
Roll roll(const std::shared_ptr<const Shape>& ball, const RollingFriction& rolling, double seconds,
          const StepSettings& settings = experimentSettings())
{
    World world;
    const MaterialId material = addRollingMaterial(world, 0.8, rolling);
    addPlane(world, material);
    const BodyId body = addBody(world, ball, material, {{0.0, 0.5, 0.0}, Quat::Identity()}, 2.0,
                                {2.0, 0.0, 0.0}, {0.0, 3.0, -4.0});
    Stepper stepper(settings);
    Roll result;
    double energy = totalEnergy(world, settings);
    for (int k = 1; k <= seconds * kRate; ++k) {
        const StepReport report = stepper.step(world, 1.0 / kRate);
        result.impulses += report.contactImpulses;
        const Vec3 spin = angularVelocityOf(world, body);
        result.reversal = std::max({result.reversal, spin.z(), -spin.y()});
        if (std::abs(spin.z()) < 1e-9) result.rollStop = std::min(result.rollStop, k / kRate);
        if (std::abs(spin.y()) < 1e-9) result.spinStop = std::min(result.spinStop, k / kRate);
        const double now = totalEnergy(world, settings);
        result.energyRise = std::max(result.energyRise, now - energy);
        energy = now;
    }
    result.distance = world.motion[body].position.x();
    result.speed = world.motion[body].velocity.x();
    return result;
}

TEST(E9RollingFriction, AnExactSphereStopsRollingAndSpinningWhenAndWhereTheorySays)
{
    for (const double mu : {0.05, 0.5}) {
        const double rollStop = 4.0 / (mu * 2.0 * 9.8), spinStop = 3.0 / (mu * 2.0 * 9.8);
        const Roll result = roll(exactSphere(0.5), {0.0, 0.0, mu, mu}, 6.0);
        EXPECT_NEAR(result.rollStop, rollStop, 0.01 * rollStop + 1.0 / kRate) << mu;
        EXPECT_NEAR(result.spinStop, spinStop, 0.01 * spinStop + 1.0 / kRate) << mu;
        EXPECT_NEAR(result.distance, rollStop, 0.01 * rollStop + 2.0 / kRate) << mu;
        EXPECT_LE(result.reversal, 1e-10) << mu;
        EXPECT_GT(result.impulses.rolling, 0);
        EXPECT_EQ(result.impulses.rollingDropped, 0);
    }
}

TEST(E9RollingFriction, WithoutItAnExactSphereRollsOnForEver)
{
    const Roll result = roll(exactSphere(0.5), {}, 6.0);
    EXPECT_NEAR(result.distance, 12.0, 0.012);
    EXPECT_NEAR(result.speed, 2.0, 0.002);
    EXPECT_EQ(result.impulses.rolling, 0);
}

// The contact point carried along as a material point lies ahead of the lowest one by the travel of
// a step, and the weight there brakes: v' = −(5/7) g v dt/R, a factor exp(−0.35) in 6 s.
TEST(E9RollingFriction, MaterialPointsInsteadOfDeepestOnesBrakeTheSameSphere)
{
    StepSettings settings = experimentSettings();
    settings.slideSmoothSamples = false;
    EXPECT_LT(roll(exactSphere(0.5), {}, 6.0, settings).speed, 1.6);
}

TEST(E9RollingFriction, ALeverArmBrakesWithThatArmTimesTheWeight)
{
    // Couple b m g against the inertia about the contact, (2/5 + 1) m R²: stops after w R² 7/(5 b
    // g).
    const double b = 0.01, rollStop = 4.0 * 0.25 * 1.4 / (b * 9.8);
    const double c = 0.02, spinStop = 3.0 * 0.25 * 0.4 / (c * 9.8);
    const Roll result = roll(exactSphere(0.5), {b, c, 0.0, 0.0}, rollStop + 0.5);
    EXPECT_NEAR(result.rollStop, rollStop, 0.01 * rollStop);
    EXPECT_NEAR(result.spinStop, spinStop, 0.01 * spinStop);
}

TEST(E9RollingFriction, TheCouplesNeverLeaveTheFrictionCone)
{
    // Braking at μ_r m g R = 49 m/s² would need five times the friction there is: what is applied
    // is halved until it fits, and the ball still stops without turning back or gaining energy.
    const Roll result = roll(exactSphere(0.5), {0.0, 0.0, 5.0, 5.0}, 2.0);
    EXPECT_LT(result.rollStop, 1.0);
    EXPECT_GT(result.rollStop, 2.0 / (0.8 * 9.8) - 2.0 / kRate);  // friction's own limit
    EXPECT_LE(result.reversal, 1e-10);
    EXPECT_LE(result.energyRise, 1e-10);
}

PassInertia randomInertia(std::uint64_t sample, std::uint64_t which)
{
    const auto draw = [&](std::uint64_t k) { return randomUnit(51, sample, 100 * which + k); };
    PassInertia inertia;
    inertia.inverseMass = 0.01 + draw(0);
    const Vec3 axis(draw(1), draw(2), draw(3));
    const Vec3 moments =
        inertia.inverseMass * (Vec3(1.0, 1.0, 1.0) + 9.0 * Vec3(draw(4), draw(5), draw(6)));
    inertia.inverseInertia =
        inverseInertiaWorld(exponentialMap(3.0 * axis).toRotationMatrix(), moments);
    return inertia;
}

// A keyed body, or one that shock has frozen, keeps an inverse inertia that no impulse may see.
TEST(E9RollingFriction, TheInertiaOfABodyThatCannotBeMovedDoesNotMatter)
{
    StickingContact contact;
    contact.inertiaS = randomInertia(0, 0);
    contact.inertiaF = heldIf(true, randomInertia(0, 1));
    contact.rS = {0.1, -0.5, 0.2};
    contact.rF = {0.3, 0.4, -0.1};
    contact.normal = Vec3::UnitY();
    contact.u = {0.02, -1.0, 0.01};
    contact.spin = {0.5, 0.3, -0.7};
    contact.friction = 0.8;
    contact.impulse = collisionMatrix(contact.inertiaS, contact.rS).inverse() * -contact.u;
    const RollingFriction resistance{0.01, 0.01, 0.0, 0.0};
    const RollingImpulse held = rollingImpulse(contact, resistance, 1.0);
    contact.inertiaF = {};
    const RollingImpulse fixed = rollingImpulse(contact, resistance, 1.0);
    EXPECT_FALSE(fixed.isDropped);
    EXPECT_EQ(held.impulse, fixed.impulse);
    EXPECT_EQ(held.couple, fixed.couple);
}

// Laws of the impulse with its couple for any two bodies, one of them immovable in every fifth
// pair.
TEST(E9RollingFriction, TenThousandRandomContactsStaySlowAndInTheConeAndGainNothing)
{
    int braked = 0;
    for (std::uint64_t sample = 0; sample < 10000; ++sample) {
        std::uint64_t next = 1000;
        const auto vector = [&] {
            Vec3 v;
            for (int k = 0; k < 3; ++k) v[k] = 2.0 * randomUnit(51, sample, next++) - 1.0;
            return v;
        };
        StickingContact contact;
        contact.inertiaS = randomInertia(sample, 0);
        if (sample % 5) contact.inertiaF = randomInertia(sample, 1);
        contact.rS = vector();
        contact.rF = vector();
        contact.normal = vector().normalized();
        contact.u = vector();
        if (contact.u.dot(contact.normal) > 0.0) contact.normal = -contact.normal;
        contact.spin = vector();
        contact.friction = 3.0;
        const Mat3 k1 = collisionMatrix(contact.inertiaS, contact.rS) +
                        collisionMatrix(contact.inertiaF, contact.rF);
        const ContactImpulse j =
            contactImpulse(k1, contact.u, contact.normal, 0.3, contact.friction);
        if (j.kind != FrictionCase::sticking) continue;
        contact.impulse = j.impulse;
        const RollingFriction resistance{0.05, 0.1, 0.02, 0.03};
        const RollingImpulse applied = rollingImpulse(contact, resistance, 1.0);
        if (applied.isDropped) {
            EXPECT_EQ(applied.impulse, contact.impulse);
            EXPECT_EQ(applied.couple, Vec3(Vec3::Zero()));
            continue;
        }
        ++braked;
        // What the bodies do, said once more by their own equations of motion.
        const auto spinGained = [](const PassInertia& inertia, const Vec3& r, const Vec3& impulse,
                                   const Vec3& couple) -> Vec3 {
            return inertia.inverseInertia * (r.cross(impulse) + couple);
        };
        const Vec3 wS = spinGained(contact.inertiaS, contact.rS, applied.impulse, applied.couple);
        const Vec3 wF = spinGained(contact.inertiaF, contact.rF, -applied.impulse, -applied.couple);
        const Vec3 u =
            contact.u +
            (contact.inertiaS.inverseMass + contact.inertiaF.inverseMass) * applied.impulse +
            wS.cross(contact.rS) - wF.cross(contact.rF);
        const double un = contact.u.dot(contact.normal);
        EXPECT_LE((u + 0.3 * un * contact.normal).norm(), 1e-10);  // still sticks, still bounces
        const double jn = applied.impulse.dot(contact.normal);
        EXPECT_LE((applied.impulse - jn * contact.normal).norm(), contact.friction * jn);
        const Vec3 spin = contact.spin + wS - wF;
        EXPECT_LE(applied.impulse.dot(0.5 * (contact.u + u)) +
                      applied.couple.dot(0.5 * (contact.spin + spin)),
                  0.0);
        const Vec3 stuck = contact.spin +
                           spinGained(contact.inertiaS, contact.rS, contact.impulse, Vec3::Zero()) -
                           spinGained(contact.inertiaF, contact.rF, -contact.impulse, Vec3::Zero());
        const double about = stuck.dot(contact.normal), left = spin.dot(contact.normal);
        EXPECT_GE(left * about, -1e-12);
        EXPECT_LE(std::abs(left), std::abs(about) + 1e-12);
        const Vec3 across = stuck - about * contact.normal;
        const Vec3 acrossLeft = spin - left * contact.normal;
        EXPECT_LE(across.cross(acrossLeft).norm(), 1e-10);
        EXPECT_GE(across.dot(acrossLeft), -1e-12);
        EXPECT_LE(acrossLeft.norm(), across.norm() + 1e-12);
    }
    EXPECT_GT(braked, 1000);
}

struct Descent {
    double distance = 0.0, acceleration = 0.0, spinRate = 0.0;
};

/// A ball released on a slope of 30°, after two seconds.
Descent descend(double friction, const RollingFriction& rolling)
{
    World world;
    const MaterialId material = addRollingMaterial(world, friction, rolling);
    const Vec3 normal(0.5, std::sqrt(0.75), 0.0), downhill(std::sqrt(0.75), -0.5, 0.0);
    addPlane(world, material, Vec3::Zero(), normal);
    const BodyId ball =
        addBody(world, exactSphere(0.5), material, {0.5 * normal, Quat::Identity()});
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 2 * kRate; ++k) stepper.step(world, 1.0 / kRate);
    return {(world.motion[ball].position - 0.5 * normal).dot(downhill),
            world.motion[ball].velocity.dot(downhill) / 2.0,
            -angularVelocityOf(world, ball).z() / 2.0};
}

TEST(E9bIncline, ARollingBallTakesFiveSeventhsOfTheSlope)
{
    const Descent result = descend(1.0, {});
    EXPECT_NEAR(result.distance, 7.0, 0.005 * 7.0);
    EXPECT_NEAR(result.acceleration, 3.5, 0.005 * 3.5);
}

TEST(E9bIncline, WithTooLittleFrictionItSlidesAndSpinsUpAsCoulombSays)
{
    const Descent result = descend(0.1, {});
    EXPECT_NEAR(result.acceleration, 4.0513, 0.005 * 4.0513);
    EXPECT_NEAR(result.spinRate, 4.2435, 0.005 * 4.2435);
}

// Theory holds the ball at tan 30° R = 0.289 m. The early contact sweeps hand out too little normal
// impulse for friction to stick, and only sticking impulses resist rolling [A49]: on a slope of 30°
// some of the resistance is lost, on level ground none.
TEST(E9bIncline, ALeverArmSlowsTheBallAndHoldsItAFifthAboveTheoreticalNeed)
{
    EXPECT_LE(std::abs(descend(1.0, {0.35, 0.0, 0.0, 0.0}).distance), 1e-6);
    const double slowed = descend(1.0, {0.1, 0.0, 0.0, 0.0}).acceleration;
    EXPECT_NEAR(slowed, 9.8 * (0.5 - 0.1 / 0.5 * std::sqrt(0.75)) / 1.4, 0.06 * slowed);
}

TEST(E9cMeshedSphere, OfTwelveHundredTrianglesLosesAtMostATwentiethOfItsSpeedInSixSeconds)
{
    EXPECT_NEAR(roll(meshSphere(), {}, 6.0).speed, 2.0, 0.1);
}

TEST(E9cMeshedSphere, WithRollingFrictionItStopsAndNeverTurnsBack)
{
    const Roll result = roll(meshSphere(), {0.0, 0.0, 0.5, 0.5}, 2.0);
    EXPECT_LT(result.rollStop, 0.6);
    EXPECT_LE(result.reversal, 1e-6);
}

TEST(E9dOtherShapes, ACubeAndAnEllipsoidWithRollingFrictionNeverGainEnergy)
{
    TriMesh egg = makeSphere(0.5, 3);
    egg.points.row(0) *= 3.0;
    const RollingFriction rolling{0.0, 0.0, 0.05, 0.05};
    for (const auto& shape : {boxShape(Vec3::Ones(), 2), buildMeshShape("egg", egg)}) {
        World world;
        const MaterialId material = addRollingMaterial(world, 0.8, rolling);
        addPlane(world, material);
        const BodyId body = addBody(world, shape, material, {{0.0, 0.5, 0.0}, Quat::Identity()},
                                    2.0, {0.0, 0.0, 1.0}, {2.0, 1.0, 0.0});
        const StepSettings settings = experimentSettings();
        Stepper stepper(settings);
        double energy = totalEnergy(world, settings), rise = 0.0, reversal = 0.0;
        for (int k = 0; k < 4 * kRate; ++k) {
            const StepReport report = stepper.step(world, 1.0 / kRate);
            const double now = totalEnergy(world, settings);
            rise = std::max(rise, now - energy - report.pushOutWork);
            energy = now;
            reversal = std::max(reversal, -angularVelocityOf(world, body).y());
        }
        EXPECT_LE(rise, 1e-9);
        // No impulse reverses the spin it brakes; corners that strike one after the other turn a
        // tumbling body by a thousandth of what it had.
        EXPECT_LE(reversal, 2e-3);
    }
}

TEST(E3Billiards, TheLastOfFiveExactBallsLeavesWithAllMomentumAndTheRestStop)
{
    for (const double gap : {0.0, 0.01}) {
        World world;
        const MaterialId floor = addMaterial(world, 0.0, 0.0), balls = addMaterial(world, 0.0, 1.0);
        addPlane(world, floor);
        for (int i = 0; i < 5; ++i) {
            addBody(world, exactSphere(1.0), balls,
                    {{-4.0 + (2.0 + gap) * i, 1.0, 0.0}, Quat::Identity()});
        }
        addBody(world, exactSphere(1.0), balls, {{-10.0, 1.0, 0.0}, Quat::Identity()}, 1.0,
                {20.0, 0.0, 0.0});
        Stepper stepper(experimentSettings());
        for (int k = 0; k < 2 * kRate; ++k) stepper.step(world, 1.0 / kRate);
        double momentum = 0.0, energy = 0.0;
        for (BodyId b = 1; b <= 6; ++b) {
            const double v = world.motion[b].velocity.x();
            EXPECT_NEAR(v, b == 5 ? 20.0 : 0.0, 1e-9) << "ball " << b << ", gap " << gap;
            momentum += v;
            energy += 0.5 * world.motion[b].velocity.squaredNorm();
        }
        EXPECT_NEAR(momentum, 20.0, 20.0 * 1e-10);
        EXPECT_NEAR(energy, 200.0, 200.0 * 1e-10);
    }
}

/// Speed of the last ball, struck by one that comes from 5 cm, and its slip v − R w.
std::array<double, 2> lastRollingBall(double seconds, const StepSettings& settings, double& others)
{
    World world;
    const MaterialId floor = addMaterial(world, 0.3, 0.0), balls = addMaterial(world, 0.0, 1.0);
    addPlane(world, floor);
    for (int i = 0; i < 5; ++i) {
        addBody(world, exactSphere(1.0), balls, {{-4.0 + 2.0 * i, 1.0, 0.0}, Quat::Identity()});
    }
    addBody(world, exactSphere(1.0), balls, {{-6.05, 1.0, 0.0}, Quat::Identity()}, 1.0,
            {20.0, 0.0, 0.0});
    Stepper stepper(settings);
    for (int k = 0; k < seconds * kRate; ++k) stepper.step(world, 1.0 / kRate);
    others = 0.0;
    for (BodyId b : {1, 2, 3, 4, 6}) others = std::max(others, world.motion[b].velocity.norm());
    const double v = world.motion[5].velocity.x();
    return {v, v + angularVelocityOf(world, 5).z()};
}

TEST(E3Billiards, TheLastBallSlidesThenRollsAtFiveSeventhsOfItsSpeed)
{
    for (const double seconds : {2.5, 6.0}) {
        double others = 0.0;
        const auto [speed, slip] = lastRollingBall(seconds, experimentSettings(), others);
        EXPECT_NEAR(speed, 100.0 / 7.0, 0.01 * 100.0 / 7.0) << seconds;
        EXPECT_LE(std::abs(slip), 1e-3) << seconds;
        EXPECT_LE(others, 0.1) << seconds;
    }
}

TEST(E3Billiards, WithMaterialPointsTheRollingBallIsBraked)
{
    StepSettings settings = experimentSettings();
    settings.slideSmoothSamples = false;
    double others = 0.0;
    EXPECT_LT(lastRollingBall(6.0, settings, others)[0], 13.5);
}

TEST(Curvature, OfASphereIsOneOverItsRadiusAndOfFlatFacesNone)
{
    const auto sphere = buildMeshShape("sphere", makeSphere(0.5, 4));
    for (int i = 0; i < 100; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = randomUnit(50, static_cast<std::uint64_t>(i), k) - 0.5;
        // Facets and trilinear cells ripple a second difference by some per cent.
        EXPECT_NEAR(meanCurvature(*sphere, 0.5 * p.normalized()), 2.0, 0.3);
    }
    EXPECT_NEAR(meanCurvature(*boxShape(Vec3::Ones(), 2), {0.1, 0.5, 0.05}), 0.0, 1e-4);
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {64, 40}));
    // Inside the hole the tube bends by 1/0.25 one way and −1/0.75 the other.
    const Vec3 inner = ring->bodyFromAsset * Vec3(0.75, 0.0, 0.0);
    EXPECT_NEAR(meanCurvature(*ring, inner), 0.5 * (4.0 - 4.0 / 3.0), 0.3);
}

TEST(Curvature, ScalesResistanceFromATenthToTenfold)
{
    const auto sphere = exactSphere(0.5);
    const Shape& ball = *sphere;
    EXPECT_NEAR(curvatureFactor(2.0, ball), 1.0, 1e-12);
    EXPECT_NEAR(curvatureFactor(4.0, ball), 0.5, 1e-12);  // on another ball: half
    EXPECT_EQ(curvatureFactor(1e9, ball), 0.1);
    EXPECT_EQ(curvatureFactor(0.0, ball), 10.0);
    EXPECT_EQ(curvatureFactor(-3.0, ball), 10.0);  // in a bowl of its own radius or hollower
}

TEST(Curvature, ScalingLeavesASphereOnAPlaneAsItIs)
{
    StepSettings plain = experimentSettings();
    plain.curvatureScaling = false;
    const RollingFriction rolling{0.0, 0.0, 0.5, 0.5};
    EXPECT_NEAR(roll(exactSphere(0.5), rolling, 1.0, plain).distance,
                roll(exactSphere(0.5), rolling, 1.0).distance, 1e-9);
}

}  // namespace
}  // namespace scree::test
