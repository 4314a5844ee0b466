// Rims of fine meshes roll like the circles that they stand for, and lie flat like the corners that
// they have.  [A40]
#include "core/geometry/round_rims.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kRadius = 0.5;

std::shared_ptr<const Shape> can(int sectors, double height = 1.0)
{
    return buildMeshShape("can", makeCylinder(kRadius, height, sectors, 2));
}

TEST(RoundRims, OnlyFineCurvesThatBendOutwardAreRims)
{
    const auto bulgeOf = [](const TriMesh& mesh) {
        return buildMeshShape("shape", mesh)->rims.bulge();
    };
    EXPECT_EQ(bulgeOf(makeBox(Vec3::Ones(), {3, 3, 3})), 0.0);
    EXPECT_EQ(bulgeOf(makeTorus(1.0, 0.25, {16, 10})), 0.0);  // the rings of figure 1
    EXPECT_EQ(bulgeOf(makeCylinder(kRadius, 1.0, 16, 2)), 0.0);
    // The sides go on into edges of the ends, which curve; with five rings these go on, too.
    EXPECT_EQ(bulgeOf(makeCapsule(0.2, 0.4, 16, 4)), 0.0);
    EXPECT_LT(bulgeOf(makeCapsule(0.2, 0.4, 16, 5)), 0.003);
    // Between two corners a circle rises by r (1 − cos π/n).
    for (const int sectors : {20, 128}) {
        const double rise = kRadius * (1.0 - std::cos(kPi / sectors));
        EXPECT_NEAR(bulgeOf(makeCylinder(kRadius, 1.0, sectors, 2)), rise, 0.01 * rise);
    }
}

TEST(RoundRims, ARimIsFacedWhereItsCircleIs)
{
    const auto shape = can(24);
    const TriMesh mesh = transformed(shape->mesh, inverse(shape->bodyFromAsset));
    const Points& points = mesh.points;
    for (int i = 0; i < 200; ++i) {
        // Downward in the frame of a lying can that is turned about its axis, and leans a little.
        const double turn = 0.0317 * i, lean = 0.2 * std::sin(i);
        const Vec3 across(std::cos(turn), 0.0, std::sin(turn));
        const Vec3 down = std::cos(lean) * across + std::sin(lean) * Vec3::UnitY();
        Eigen::Index lowest = 0;
        (down.transpose() * points).maxCoeff(&lowest);
        std::int32_t rim = shape->rims.atCorner(static_cast<std::int32_t>(lowest));
        ASSERT_GE(rim, 0);
        RoundPlace place;
        const Vec3 own = shape->bodyFromAsset.orientation * down;
        ASSERT_EQ(shape->rims.findFacing(rim, own, place), RoundSearch::found);
        const Vec3 onCircle =
            kRadius * across + std::copysign(0.5, points(1, lowest)) * Vec3::UnitY();
        const Vec3 smooth = inverse(shape->bodyFromAsset) * place.point + place.bulge * down;
        EXPECT_NEAR(smooth.dot(down), onCircle.dot(down), 1e-4 * kRadius);
        EXPECT_LE((smooth - onCircle).norm(), 2e-3 * kRadius);
    }
}

// Searches turn a normal by what the place says that it will move by. It said along the tangent,
// where it moves along the chord: they crept up on the contact of two rims that cross at a flat
// angle, and one in twenty-five was given up and told as of polygons, a thousandth of a coin apart.
TEST(RoundRims, TheFacedPlaceAdvancesAsItSays)
{
    const auto shape = can(24);
    constexpr double kTurn = 1e-6;
    for (int i = 0; i < 200; ++i) {
        const double turn = 0.0317 * i, lean = 1.2 * std::sin(i);
        const Vec3 across(std::cos(turn), 0.0, std::sin(turn));
        const Vec3 faced = shape->bodyFromAsset.orientation *
                           Vec3(std::cos(lean) * across + std::sin(lean) * Vec3::UnitY());
        Eigen::Index lowest = 0;
        (faced.transpose() * shape->mesh.points).maxCoeff(&lowest);
        std::int32_t rim = shape->rims.atCorner(static_cast<std::int32_t>(lowest));
        RoundPlace here, there;
        ASSERT_EQ(shape->rims.findFacing(rim, faced, here), RoundSearch::found);
        for (const Vec3& aside : {faced.unitOrthogonal(), faced.cross(faced.unitOrthogonal())}) {
            const Vec3 change = kTurn * aside;
            std::int32_t next = rim;
            ASSERT_EQ(shape->rims.findFacing(next, (faced + change).normalized(), there),
                      RoundSearch::found);
            if (next != rim) continue;  // beyond the corner the chord is another
            const Vec3 moved = there.point - here.point;
            EXPECT_LE((here.advance * change - moved).norm(), 1e-4 * moved.norm() + 1e-12) << i;
        }
    }
}

struct Rolled {
    double speed, height, across;
};

/// What rolls along x at 2 m/s with its axis along z, after 3 s.
Rolled rolled(const std::shared_ptr<const Shape>& shape, double radius, double rate)
{
    World world;
    const MaterialId material = addMaterial(world, 0.8, 0.0);
    addPlane(world, material);
    const Pose lying{{0.0, radius, 0.0}, exponentialMap(Vec3(0.5 * kPi, 0.0, 0.0))};
    const BodyId body =
        addBody(world, shape, material, lying, 2.0, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0 / radius});
    Stepper stepper(screeSettings());
    for (int i = 0; i < 3.0 * rate; ++i) stepper.step(world, 1.0 / rate);
    const BodyMotion& motion = world.motion[body];
    return {motion.velocity.x(), motion.position.y(), motion.position.z()};
}

TEST(RoundRims, CansAndHoopsRollOnAtTheirSpeedAtAnyStep)
{
    const auto hoop = buildMeshShape("hoop", makeTorus(0.45, 0.05, {64, 12}));
    for (const double rate : {48.0, 240.0}) {
        for (const auto& shape : {can(20), can(128), hoop, exactCylinder(kRadius, 0.3)}) {
            const Rolled end = rolled(shape, kRadius, rate);
            EXPECT_NEAR(end.speed, 2.0, 2e-3) << shape->name << rate;
            EXPECT_NEAR(end.height, kRadius, 1e-4) << shape->name << rate;
            EXPECT_NEAR(end.across, 0.0, 1e-3) << shape->name << rate;
        }
        // Of 30° between two sides a can is a prism, and each of them stops it.
        EXPECT_LT(rolled(can(12), kRadius, rate).speed, 1.0);
    }
}

/// A wheel of so many sides that is inelastic and does not slip: what is left of its spin goes on
/// about the next corner, I + m r² cos α of I + m r² for sides that turn by α, and has to lift it
/// over that.
struct Polygon {
    double radius, turn, ownInertia;  ///< [m], [rad], about the axis for a mass of 1 [m²]

    double inertia() const { return ownInertia + radius * radius; }
    double keeps() const { return (ownInertia + radius * radius * std::cos(turn)) / inertia(); }
    double side() const { return 2.0 * radius * std::sin(0.5 * turn); }

    /// The way that it rolls in so long, beginning on a side about the corner ahead [m].
    double rollsIn(double seconds, double spin) const
    {
        constexpr int kParts = 1000;
        for (int sides = 0;; ++sides) {
            for (int i = 0; i < kParts; ++i) {
                const double angle = ((i + 0.5) / kParts - 0.5) * turn;
                const double lifted = radius * (std::cos(angle) - std::cos(0.5 * turn));
                const double squared = spin * spin - 2.0 * 9.81 * lifted / inertia();
                if (squared <= 0.0) return sides * side();
                seconds -= turn / kParts / std::sqrt(squared);
                if (seconds < 0.0) return (sides + (i + 0.5) / kParts) * side();
            }
            spin *= keeps();
        }
    }
};

// The rings of the scene that speed is measured on have sixteen sides, and some roll away from the
// heap. Nothing but its corners stops such a ring: at 2.5 m/s it goes on for longer than the ten
// seconds after which the scene is judged, and by theory for longer still.
/// What a profile of radii and heights, from the lower end to the upper, makes when it goes round
/// y.
TriMesh turnedOnALathe(const std::vector<Eigen::Vector2d>& profile, int sectors)
{
    const auto rings = static_cast<int>(profile.size());
    TriMesh mesh;
    mesh.points.resize(3, rings * sectors + 2);
    for (int ring = 0; ring < rings; ++ring) {
        for (int i = 0; i < sectors; ++i) {
            const double angle = 2.0 * kPi * i / sectors, r = profile[ring].x();
            mesh.points.col(ring * sectors + i) =
                Vec3(r * std::cos(angle), profile[ring].y(), r * std::sin(angle));
        }
    }
    const int bottom = rings * sectors, top = bottom + 1;
    mesh.points.col(bottom) = Vec3(0.0, profile.front().y(), 0.0);
    mesh.points.col(top) = Vec3(0.0, profile.back().y(), 0.0);
    std::vector<Eigen::Vector3i> triangles;
    for (int i = 0; i < sectors; ++i) {
        const int next = (i + 1) % sectors;
        triangles.emplace_back(bottom, i, next);
        triangles.emplace_back(top, (rings - 1) * sectors + next, (rings - 1) * sectors + i);
        for (int below = 0; below < (rings - 1) * sectors; below += sectors) {
            triangles.emplace_back(below + i, below + sectors + i, below + next);
            triangles.emplace_back(below + next, below + sectors + i, below + sectors + next);
        }
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i)
        mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangles[i];
    return mesh;
}

// Where the tread bends into the bevel by 20° or less no edge was a rim, and the facets beside it
// were none that are round: a tyre was a polygon, and one with a bevel of 20° lost a seventh of its
// speed in a second.
TEST(RoundRims, WheelsRollOnHoweverGentlyTheirTreadsEnd)
{
    const double r = kRadius, half = 0.2;
    std::vector<std::vector<Eigen::Vector2d>> profiles;
    for (const double degrees : {3.0, 8.0, 20.0, 40.0}) {  // with a tread, and without
        const double fall = 0.15 * std::tan(degrees * kPi / 180.0);
        profiles.push_back({{r - fall, -half}, {r, -0.05}, {r, 0.05}, {r - fall, half}});
        profiles.push_back({{r - fall, -half}, {r, 0.0}, {r - fall, half}});
    }
    std::vector<Eigen::Vector2d> can, barrel;
    for (int k = -4; k <= 4; ++k) {
        const double angle = 0.125 * kPi * k;
        can.emplace_back(r - 0.05 + 0.05 * std::cos(angle), 0.1 * k / 4.0 + 0.05 * std::sin(angle));
        barrel.emplace_back(r - 0.003 * k * k, 0.05 * k);
    }
    profiles.push_back(can);
    profiles.push_back(barrel);
    for (const auto& profile : profiles) {
        const auto shape = buildMeshShape("wheel", turnedOnALathe(profile, 96));
        World world;
        const MaterialId material = addMaterial(world, 0.9, 0.0, 700.0);
        addPlane(world, material);
        const double mass = 700.0 * shape->unitMass.volume;
        addBody(world, shape, material,
                {Vec3(0.0, kRadius, 0.0), exponentialMap({0.5 * kPi, 0.0, 0.0})}, mass,
                {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0 / kRadius});
        Stepper stepper(screeSettings());
        for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_NEAR(world.motion[1].velocity.x(), 1.0, 2e-3) << profile.front().transpose();
        EXPECT_NEAR(world.motion[1].velocity.z(), 0.0, 2e-3) << profile.front().transpose();
    }
}

TEST(RoundRims, AWheelOfSixteenSidesRollsForTenSecondsAndLosesAboutWhatItsCornersTake)
{
    constexpr double kSeconds = 10.0, kCorner = 1.25, kTurn = kPi / 8.0;
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const Quat upright = exponentialMap(Vec3(0.5 * kPi, 0.0, 0.0));
    const Vec3 centre(0.0, kCorner * std::cos(0.5 * kTurn), 0.0);
    const Vec3 ahead(kCorner * std::sin(0.5 * kTurn), 0.0, 0.0), spin(0.0, 0.0, -2.0);
    for (const double rate : {96.0, 240.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.8, 0.0);
        addPlane(world, material);
        const BodyId body =
            addBody(world, ring, material, {centre, rotated(upright, {0.0, 0.0, 0.5 * kTurn})}, 1.0,
                    spin.cross(centre - ahead), spin);
        Stepper stepper(screeSettings());
        for (int i = 0; i < rate * kSeconds; ++i) stepper.step(world, 1.0 / rate);
        const double inertia = 1.0 / world.mass[body].inverseInertia.minCoeff();
        const double inTheory = Polygon{kCorner, kTurn, inertia}.rollsIn(kSeconds, spin.norm());
        const BodyMotion& motion = world.motion[body];
        EXPECT_NEAR(motion.position.x(), inTheory, 0.12 * inTheory) << rate;
        EXPECT_GT(motion.velocity.norm(), 0.3) << rate;
        EXPECT_GT(motion.position.y(), 1.2) << rate;
    }
}

TEST(RoundRims, ABarrelGainsTwoThirdsOfGravityDownASlope)
{
    World world;
    const MaterialId material = addMaterial(world, 0.8, 0.0);
    const double slope = 0.05;
    const Vec3 normal(std::sin(slope), std::cos(slope), 0.0);
    addPlane(world, material, Vec3::Zero(), normal);
    const BodyId body = addBody(world, can(64), material,
                                {kRadius * normal, exponentialMap(Vec3(0.5 * kPi, 0.0, 0.0))}, 2.0);
    Stepper stepper(screeSettings());
    for (int i = 0; i < 4 * 96; ++i) stepper.step(world, 1.0 / 96.0);
    const double expected = 2.0 / 3.0 * screeSettings().gravity.norm() * 4.0 * std::sin(slope);
    EXPECT_NEAR(world.motion[body].velocity.norm(), expected, 2e-3 * expected);
}

TEST(RoundRims, WhatStandsOnItsRimStandsAndWhatFallsOntoItLiesFlat)
{
    for (const double lean : {0.0, 0.03, 0.12}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addPlane(world, material);
        const double height = kRadius * std::sin(lean) + 0.05 * std::cos(lean);
        const BodyId coin = addBody(world, can(48, 0.1), material,
                                    {{0.0, height, 0.0}, exponentialMap(Vec3(lean, 0.0, 0.0))});
        Stepper stepper(screeSettings());
        for (int i = 0; i < 5 * 96; ++i) stepper.step(world, 1.0 / 96.0);
        const Aabb box = boxAt(world.shapeOf(coin), world.motion[coin].worldFromBody());
        EXPECT_NEAR(box.min.y(), 0.0, 2e-5) << lean;
        EXPECT_NEAR(box.max.y(), 0.1, 2e-5) << lean;
        EXPECT_LE(world.motion[coin].velocity.norm(), 1e-6) << lean;
    }
}

// It may be drawn as a prism: of twelve sides it lost two thirds of its speed in 2 s.
TEST(RoundRims, AnExactCylinderRollsHoweverItIsDrawn)
{
    for (const int sectors : {8, 12, 20}) {
        World world;
        const MaterialId material = addMaterial(world, 0.8, 0.0);
        addPlane(world, material);
        const auto shape = buildExactShape("can", ExactSolid::cylinder(kRadius, 1.0),
                                           makeCylinder(kRadius, 1.0, sectors, 1));
        const Quat lying = rotated(Quat::Identity(), Vec3(0.5 * kPi, 0.0, 0.0));
        const BodyId body = addBody(world, shape, material, {{0.0, kRadius, 0.0}, lying}, 2.0,
                                    {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0 / kRadius});
        Stepper stepper(screeSettings());
        for (int k = 0; k < 240; ++k) stepper.step(world, 1.0 / 240.0);
        EXPECT_NEAR(world.motion[body].velocity.x(), 2.0, 1e-3) << sectors;
        EXPECT_NEAR(world.motion[body].position.y(), kRadius, 1e-4) << sectors;
    }
}

// Its rim passes the side of the block ahead, but on top of it: told of that it stopped dead, or
// fell over.
TEST(RoundRims, ACanSlidesOverASeamAsOverAFloor)
{
    constexpr double kFriction = 0.2, kSpeed = 1.5;
    const auto block = exactBox({1.0, 0.2, 1.0}, 1);
    for (const auto& shape : {can(32), can(20), exactCylinder(kRadius, 1.0)}) {
        World world;
        const MaterialId material = addMaterial(world, kFriction, 0.0);
        for (const double x : {-0.5, 0.5})
            addFixed(world, material, block, {{x, -0.1, 0.0}, Quat::Identity()});
        const BodyId body = addBody(world, shape, material, {{-0.6, 0.5, 0.0}, Quat::Identity()},
                                    1.0, {kSpeed, 0.0, 0.0});
        const Vec3 start = world.motion[body].position;
        Stepper stepper(screeSettings());
        for (int k = 0; k < 240; ++k) stepper.step(world, 1.0 / 240.0);
        const double stops = kSpeed * kSpeed / (2.0 * kFriction * 9.8);
        const Vec3 way = world.motion[body].position - start;
        EXPECT_NEAR(way.x(), stops, 0.01 * stops) << shape->name;
        EXPECT_NEAR(way.y(), 0.0, 1e-3) << shape->name;
    }
}

}  // namespace
}  // namespace scree::test
