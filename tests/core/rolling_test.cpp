// Rolling and spinning friction beside what E9 and E3 of scree verify prove: lever arms, the cone,
// the laws of a single impulse, curvature. [GBF03 “Rolling and Spinning Friction”]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/rolling_friction.h"
#include "core/dynamics/step_figures.h"
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
    double energy = mechanicalEnergy(world, settings.gravity);
    for (int k = 1; k <= seconds * kRate; ++k) {
        const StepReport report = stepper.step(world, 1.0 / kRate);
        result.impulses += report.contactImpulses;
        const Vec3 spin = angularVelocityOf(world, body);
        result.reversal = std::max({result.reversal, spin.z(), -spin.y()});
        if (std::abs(spin.z()) < 1e-9) result.rollStop = std::min(result.rollStop, k / kRate);
        if (std::abs(spin.y()) < 1e-9) result.spinStop = std::min(result.spinStop, k / kRate);
        const double now = mechanicalEnergy(world, settings.gravity);
        result.energyRise = std::max(result.energyRise, now - energy);
        energy = now;
    }
    result.distance = world.motion[body].position.x();
    result.speed = world.motion[body].velocity.x();
    return result;
}

TEST(E9RollingFriction, ALeverArmBrakesWithThatArmTimesTheWeight)  // [A49]
{
    // Couple b m g against the inertia about the contact, (2/5 + 1) m R²: stops after w R² 7/(5 b
    // g).
    const double b = 0.01, rollStop = 4.0 * 0.25 * 1.4 / (b * 9.8);
    const double c = 0.02, spinStop = 3.0 * 0.25 * 0.4 / (c * 9.8);
    const Roll result = roll(exactSphere(0.5), {b, c, 0.0, 0.0}, rollStop + 0.5);
    EXPECT_NEAR(result.rollStop, rollStop, 0.01 * rollStop);
    EXPECT_NEAR(result.spinStop, spinStop, 0.01 * spinStop);
}

// A barrel touches the ground with both its rims, where its field has a sharp edge. By what that
// measures there barrels were braked by a quarter of their arm, or by a tenth where the field was
// finer; balls of facets by a tenth too much.
constexpr double kRadius = 0.3, kGravity = 9.8;

struct Roller {
    const char* name;
    TriMesh mesh;
    double inertia;  // about its axis, of a mass and a radius of one
};

std::vector<Roller> rollers()
{
    return {{"barrel", makeCylinder(kRadius, 0.8, 48, 1), 0.5},
            {"coin", makeCylinder(kRadius, 0.1, 48, 1), 0.5},
            {"ball", makeSphere(kRadius, 3), 0.4}};
}

/// Something round with an arm of `b` [m] that has rolled for a second from `speed` down a slope.
BodyMotion rolledDown(const std::shared_ptr<const Shape>& shape, double b, double speed,
                      double slope)
{
    World world;
    const MaterialId material = addRollingMaterial(world, 0.8, {b, 0.0, 0.0, 0.0});
    addPlane(world, material);
    const BodyId body = addBody(world, shape, material,
                                {{0.0, kRadius, 0.0}, exponentialMap({0.5 * kPi, 0.0, 0.0})}, 2.0,
                                {speed, 0.0, 0.0}, {0.0, 0.0, -speed / kRadius});
    StepSettings steps = screeSettings();
    steps.gravity = kGravity * Vec3(std::sin(slope), -std::cos(slope), 0.0);
    Stepper stepper(steps);
    for (int frame = 0; frame < 24; ++frame) stepper.advanceFrame(world, 1.0 / 24.0);
    return world.motion[body];
}

BodyMotion rolledDown(const Roller& roller, double b, double speed, double slope, int resolution)
{
    ShapeSettings settings;
    settings.resolution = resolution;
    return rolledDown(buildMeshShape(roller.name, roller.mesh, settings), b, speed, slope);
}

TEST(RollingFriction, AnExactBarrelIsBrakedByItsArm)  // [A49, A50]
{
    const double b = 0.003, theory = b * kGravity / (1.5 * kRadius);
    const double speed = rolledDown(exactCylinder(kRadius, 0.8), b, 1.0, 0.0).velocity.x();
    EXPECT_NEAR(1.0 - speed, theory, 0.03 * theory);  // it was ten times that
}

TEST(RollingFriction, ABallABarrelAndACoinAreBrakedByTheirArmHoweverFineTheirFields)  // [A49, A50]
{
    const double b = 0.003;
    for (const Roller& roller : rollers()) {
        const double theory = b * kGravity / ((1.0 + roller.inertia) * kRadius);
        for (const int resolution : {40, 100}) {
            const double speed = rolledDown(roller, b, 1.0, 0.0, resolution).velocity.x();
            EXPECT_NEAR(1.0 - speed, theory, 0.03 * theory) << roller.name << ' ' << resolution;
        }
    }
}

TEST(RollingFriction, TheyLieOnASlopeAsSteepAsTheirArmIsLong)  // [A49, A50]
{
    const double b = 0.05 * kRadius;
    for (const Roller& roller : rollers()) {
        EXPECT_LT(rolledDown(roller, b, 0.0, std::atan(0.045), 40).position.x(), 1e-5)
            << roller.name;
        const double slope = std::atan(0.06), theory = 0.5 * kGravity *
                                                       (std::sin(slope) - 0.05 * std::cos(slope)) /
                                                       (1.0 + roller.inertia);
        EXPECT_NEAR(rolledDown(roller, b, 0.0, slope, 40).position.x(), theory, 0.03 * theory)
            << roller.name;
    }
}

// With a couple that stopped the spin of a free ball it crept on for another fourteen steps.
TEST(E9RollingFriction, WithMethodScreeABallStandsInTheVeryStepThatTheorySays)
{
    const double rollStop = 4.0 / (0.5 * 2.0 * 9.8), spinStop = 3.0 / (0.5 * 2.0 * 9.8);
    const Roll result = roll(exactSphere(0.5), {0.0, 0.0, 0.5, 0.5}, 1.0, screeSettings());
    EXPECT_GE(result.rollStop, rollStop);
    EXPECT_LE(result.rollStop, rollStop + 1.0 / kRate);
    EXPECT_NEAR(result.spinStop, spinStop, 0.01 * spinStop);
    EXPECT_LE(result.reversal, 1e-10);
}

TEST(E9RollingFriction, TheCouplesNeverLeaveTheFrictionCone)  // [A51]
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
TEST(E9RollingFriction, OfTwoFreeBallsNoneRollsAboutThePlaceTheyTouch)  // [A49]
{
    const PassInertia fixed, ball{0.5, 5.0 * Mat3::Identity()};
    const Vec3 r(0.0, -0.5, 0.0);
    // On something fixed the centre goes along, 1 / (I + m R²); two that are free turn against each
    // other like gears, with their centres where they are.
    EXPECT_NEAR(rollingResponse(ball, r, fixed, Vec3::Zero())(0, 0), 1.0 / (0.2 + 2.0 * 0.25),
                1e-14);
    EXPECT_NEAR(rollingResponse(ball, r, ball, -r)(0, 0), 2.0 / 0.2, 1e-13);
    EXPECT_TRUE(rollingResponse(fixed, r, fixed, -r).isZero(0.0));
}

TEST(E9RollingFriction, TheInertiaOfABodyThatCannotBeMovedDoesNotMatter)  // [A51]
{
    StickingContact contact;
    contact.inertiaS = randomInertia(0, 0);
    contact.inertiaF = fixedIf(true, randomInertia(0, 1));
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
TEST(E9RollingFriction, TenThousandRandomContactsStaySlowAndInTheConeAndGainNothing)  // [A49, A51]
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

// Theory holds the ball at tan 30° R = 0.289 m. The early contact sweeps hand out too little normal
// impulse for friction to stick, and only sticking impulses resist rolling [A49]: on a slope of 30°
// some of the resistance is lost, on level ground none.
TEST(E9bIncline, ALeverArmSlowsTheBallAndHoldsItAFifthAboveTheoreticalNeed)
{
    EXPECT_LE(std::abs(descend(1.0, {0.35, 0.0, 0.0, 0.0}).distance), 1e-6);
    const double slowed = descend(1.0, {0.1, 0.0, 0.0, 0.0}).acceleration;
    EXPECT_NEAR(slowed, 9.8 * (0.5 - 0.1 / 0.5 * std::sqrt(0.75)) / 1.4, 0.06 * slowed);
}

TEST(Curvature, OfASphereIsOneOverItsRadiusAndOfFlatFacesNone)  // [A50]
{
    const auto sphere = buildMeshShape("sphere", makeSphere(0.5, 4));
    const auto block = boxShape(Vec3::Ones(), 2);
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {64, 40}));
    for (const auto& curvature : {meanCurvature, meanCurvatureOfCells}) {
        for (int i = 0; i < 100; ++i) {
            Vec3 p;
            for (int k = 0; k < 3; ++k)
                p[k] = randomUnit(50, static_cast<std::uint64_t>(i), k) - 0.5;
            // Facets and trilinear cells ripple a second difference by some per cent.
            EXPECT_NEAR(curvature(*sphere, 0.5 * p.normalized()), 2.0, 0.3);
        }
        EXPECT_NEAR(curvature(*block, {0.1, 0.5, 0.05}), 0.0, 1e-4);
        // Inside the hole the tube bends by 1/0.25 one way and −1/0.75 the other.
        const Vec3 inner = ring->bodyFromAsset * Vec3(0.75, 0.0, 0.0);
        EXPECT_NEAR(curvature(*ring, inner), 0.5 * (4.0 - 4.0 / 3.0), 0.3);
    }
}

TEST(Curvature, ScalesResistanceFromATenthToTenfold)  // [A50]
{
    const auto sphere = exactSphere(0.5);
    const Shape& ball = *sphere;
    EXPECT_NEAR(curvatureFactor(2.0, ball), 1.0, 1e-12);
    EXPECT_NEAR(curvatureFactor(4.0, ball), 0.5, 1e-12);  // on another ball: half
    EXPECT_EQ(curvatureFactor(1e9, ball), 0.1);
    EXPECT_EQ(curvatureFactor(0.0, ball), 10.0);
    EXPECT_EQ(curvatureFactor(-3.0, ball), 10.0);  // in a bowl of its own radius or hollower
}

TEST(Curvature, ScalingLeavesASphereOnAPlaneAsItIs)  // [A50]
{
    StepSettings plain = experimentSettings();
    plain.curvatureScaling = false;
    const RollingFriction rolling{0.0, 0.0, 0.5, 0.5};
    EXPECT_NEAR(roll(exactSphere(0.5), rolling, 1.0, plain).distance,
                roll(exactSphere(0.5), rolling, 1.0).distance, 1e-9);
}

}  // namespace
}  // namespace scree::test
