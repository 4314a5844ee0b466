// Exact spheres, boxes and cylinders: against meshes and closed forms, deepest points, rest.  [A9]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/collision/interference.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

std::vector<ExactSolid> solids()
{
    return {ExactSolid::sphere(0.5), ExactSolid::box({1.0, 0.6, 1.4}),
            ExactSolid::cylinder(0.4, 1.5)};
}

TEST(ExactSolid, GradientIsThatOfTheDistanceAndOfUnitLength)
{
    for (const ExactSolid& solid : solids()) {
        int compared = 0;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Vec3 p = randomPlace(9, i, solid.box().grown(0.5));
            const Vec3 gradient = solid.gradient(p);
            EXPECT_NEAR(gradient.norm(), 1.0, 1e-12);
            constexpr double kStep = 1e-5;
            Vec3 difference;
            for (int k = 0; k < 3; ++k) {
                const Vec3 step = kStep * Vec3::Unit(k);
                difference[k] = (solid.value(p + step) - solid.value(p - step)) / (2.0 * kStep);
            }
            // On the medial axis inside there is no gradient to compare with.
            if (difference.norm() < 0.999) continue;
            ++compared;
            EXPECT_LE((difference - gradient).norm(), 1e-3);
        }
        EXPECT_GT(compared, 19000);
    }
}

TEST(ExactSolid, AWayEntersAtTheSurfaceOrNotAtAll)
{
    for (const ExactSolid& solid : solids()) {
        int entered = 0;
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const Vec3 from = randomPlace(9, 2 * i, solid.box().grown(0.5));
            const Vec3 to = randomPlace(9, 2 * i + 1, solid.box());
            if (solid.value(to) > 0.0) continue;
            const auto place = solid.entry(from, to, 1e-9);
            EXPECT_EQ(place.has_value(), solid.value(from) > 0.0);
            if (!place) continue;
            ++entered;
            EXPECT_NEAR(solid.value(*place), 0.0, 1e-12);
            EXPECT_LE((*place - from).norm() + (to - *place).norm(), (to - from).norm() + 1e-12);
        }
        EXPECT_GT(entered, 5000);
    }
}

TEST(E21SignedDistance, MeshesOfExactSolidsAgreeWithTheirFormulas)
{
    const Vec3 size(1.0, 0.7, 1.2);
    const auto box = buildMeshShape("box", makeBox(size, {2, 2, 2}));
    const ExactSolid exactBoxSolid = ExactSolid::box(size);
    const auto ball = buildMeshShape("ball", makeSphere(0.5, 5));
    const double h = ball->distance.spacing();
    // Facets of 0.033 R lie R (0.033)²/6 inside the sphere at their middles.
    const double allowed = 0.3 * h * h / 0.5 + 0.5 * 0.033 * 0.033 / 6.0;
    for (std::uint64_t i = 0; i < 50000; ++i) {
        const Vec3 p = randomPlace(9, i, box->box.grown(0.1));
        const double exact = exactBoxSolid.value(inverse(box->bodyFromAsset) * p);
        if (std::abs(exact) < 0.5 * box->distance.spacing()) {
            EXPECT_NEAR(box->distance.value(p), exact, 1e-9);
        }
        const Vec3 q = randomPlace(9, i, ball->box.grown(0.1));
        const double radial = q.norm() - 0.5;
        // Deeper, some nodes at the end of the lattice builder's band are off by a tenth of h.
        if (std::abs(radial) > h) continue;
        EXPECT_LE(std::abs(ball->distance.gridValue(q) - radial), allowed);
    }
}

TEST(ExactSolid, MassIsThatOfTheSolidWhichFineMeshesApproach)
{
    const auto worst = [](const MassProperties& mesh, const MassProperties& exact) {
        Vec3 sorted = exact.moments;
        std::sort(sorted.data(), sorted.data() + 3);
        return std::max(
            {std::abs(mesh.volume / exact.volume - 1.0), std::abs(mesh.area / exact.area - 1.0),
             (mesh.moments.cwiseQuotient(sorted) - Vec3::Ones()).cwiseAbs().maxCoeff()});
    };
    const Vec3 size(1.0, 0.6, 1.4);
    EXPECT_LE(
        worst(massProperties(makeBox(size, {2, 2, 2})), ExactSolid::box(size).massProperties()),
        1e-12);
    // Second order: 320 sectors are off by (2π/320)²/3 or so, a sphere of six divisions by less.
    EXPECT_LE(worst(massProperties(makeCylinder(0.4, 1.5, 320, 1)),
                    ExactSolid::cylinder(0.4, 1.5).massProperties()),
              3e-4);
    EXPECT_LE(worst(massProperties(makeSphere(0.5, 6)), ExactSolid::sphere(0.5).massProperties()),
              6e-4);
}

double deepestPhi(const std::shared_ptr<const Shape>& a, const Pose& poseA,
                  const std::shared_ptr<const Shape>& b, const Pose& poseB, std::size_t& count)
{
    std::vector<Touch> touches;
    Proximity proximity;
    proximity.setMargin(1e-3);
    proximity.findTouches({a.get(), b.get(), poseA, poseB}, 1e-6, touches);
    count = touches.size();
    double deepest = 1e300;
    for (const Touch& touch : touches) deepest = std::min(deepest, touch.phi);
    return deepest;
}

TEST(MovingSamples, ASphereIsAsDeepAsItsCentreIsNear)
{
    std::size_t count = 0;
    const auto ball = exactSphere(0.5);
    const Pose at{{0.1, 0.97, 0.2}, exponentialMap({0.3, 0.2, 0.1})};
    for (const auto& block : {exactBox(Vec3::Ones(), 2), boxShape(Vec3::Ones(), 2)}) {
        // Deeper than the refined band of the mesh its single-precision lattice answers.
        const double tolerance = block->distance.solid() ? 1e-12 : 1e-8;
        EXPECT_NEAR(deepestPhi(ball, at, block, {}, count), -0.03, tolerance);
        EXPECT_NEAR(deepestPhi(block, {}, ball, at, count), -0.03, tolerance);
    }
    const auto plane = buildPlaneShape("plane");
    EXPECT_NEAR(deepestPhi(ball, {{3.0, 0.45, 1.0}, at.orientation}, plane, {}, count), -0.05,
                1e-12);
    EXPECT_EQ(count, 1u);
    const Vec3 away = 0.98 * Vec3(1.0, 2.0, 2.0) / 3.0;
    EXPECT_NEAR(deepestPhi(ball, {away, at.orientation}, ball, {}, count), -0.02, 1e-12);
}

TEST(MovingSamples, ASphereThroughAThinPlateIsStillSeenInside)
{
    // The far side of the ball lies beyond the plate; its deepest point is the middle of the plate.
    std::size_t count = 0;
    const auto plate = exactBox({2.0, 0.1, 2.0}, 1);
    EXPECT_NEAR(
        deepestPhi(exactSphere(0.5), {{0.13, 0.35, 0.07}, Quat::Identity()}, plate, {}, count),
        -0.05, 1e-12);
}

TEST(MovingSamples, ATiltedCylinderTouchesWithTheLowestPointOfItsRim)
{
    std::size_t count = 0;
    const auto pole = exactCylinder(0.4, 1.5);
    const auto plane = buildPlaneShape("plane");
    const auto slab = exactBox({9.0, 1.0, 9.0}, 1);
    for (const double tilt : {0.3, 1.0, 1.5}) {
        const Quat q = exponentialMap(tilt * Vec3(0.6, 0.0, 0.8));
        const double reach = 0.75 * std::cos(tilt) + 0.4 * std::sin(tilt);
        const Pose at{{0.0, reach - 0.01, 0.0}, q};
        EXPECT_NEAR(deepestPhi(pole, at, plane, {}, count), -0.01, 1e-12);
        // Found by search instead of by formula: an angle off by 0.005° costs 1e-9 of the radius.
        const Pose under{{0.0, -0.5, 0.0}, Quat::Identity()};
        EXPECT_NEAR(deepestPhi(pole, at, slab, under, count), -0.01, 1e-8);
    }
    deepestPhi(pole, {{0.0, 0.75, 0.0}, Quat::Identity()}, plane, {}, count);
    EXPECT_EQ(count, 9u);  // it stands on eight points, and one of them is deepest
}

TEST(MovingSamples, CrossedCylindersTouchBetweenTheirAxes)
{
    std::size_t count = 0;
    const auto pole = exactCylinder(0.4, 3.0);
    const Pose flat{Vec3::Zero(), exponentialMap({0.5 * kPi, 0.0, 0.0})};
    const Pose across{{0.2, 0.79, 0.1}, exponentialMap({0.0, 0.0, 0.5 * kPi})};
    EXPECT_NEAR(deepestPhi(pole, flat, pole, across, count), -0.01, 1e-9);
}

TEST(ExactCylinder, StaysOnASteepRoughPlane)
{
    const Quat tilt = exponentialMap({0.0, 0.0, -kPi / 6.0});
    const Vec3 up = tilt * Vec3::UnitY();
    for (const double rate : {24.0, 240.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.7, 1.0);
        addPlane(world, material, Vec3::Zero(), up);
        const BodyId block = addBody(world, exactCylinder(0.5, 1.0), material, {0.5 * up, tilt});
        const World before = world;
        Stepper stepper(experimentSettings());
        for (int k = 0; k < 3 * rate; ++k) stepper.step(world, 1.0 / rate);
        EXPECT_LE(largestVertexShift(before, world, block), 1e-9) << rate << " Hz";
    }
}

TEST(E1BlockAtRest, AnExactBoxStaysOnAnExactSlab)
{
    World world;
    const MaterialId material = addMaterial(world, 0.7, 1.0);
    const Quat tilt = exponentialMap({0.0, 0.0, -kPi / 6.0});
    addBody(world, exactBox({6.0, 1.0, 6.0}, 1), material, {tilt * Vec3(0.0, -0.5, 0.0), tilt},
            0.0);
    const BodyId block =
        addBody(world, exactBox(Vec3::Ones(), 2), material, {tilt * Vec3(0.1, 0.5, 0.2), tilt});
    const World before = world;
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 3 * 60; ++k) stepper.step(world, 1.0 / 60.0);
    EXPECT_LE(largestVertexShift(before, world, block), 1e-6);
}

TEST(ExactCylinder, RollsOnItsSideForEver)
{
    World world;
    const MaterialId material = addMaterial(world, 0.8, 0.0);
    addPlane(world, material);
    const BodyId log = addBody(world, exactCylinder(0.5, 2.0), material,
                               {{0.0, 0.5, 0.0}, exponentialMap({0.5 * kPi, 0.0, 0.0})}, 2.0,
                               {2.0, 0.0, 0.0}, {0.0, 0.0, -4.0});
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 3 * 240; ++k) stepper.step(world, 1.0 / 240.0);
    EXPECT_NEAR(world.motion[log].velocity.x(), 2.0, 0.002);
    EXPECT_NEAR(world.motion[log].position.y(), 0.5, 1e-3);
    EXPECT_NEAR(world.motion[log].position.z(), 0.0, 1e-6);
}

TEST(ExactCylinder, DroppedAcrossAnotherItComesToRestOnIt)
{
    World world;
    const MaterialId material = addMaterial(world, 0.8, 0.0);
    addBody(world, exactCylinder(0.5, 4.0), material,
            {Vec3::Zero(), exponentialMap({0.5 * kPi, 0.0, 0.0})}, 0.0);
    const BodyId upper = addBody(world, exactCylinder(0.3, 4.0), material,
                                 {{0.0, 0.85, 0.0}, exponentialMap({0.0, 0.0, 0.5 * kPi})});
    Stepper stepper(experimentSettings());
    for (int k = 0; k < 240; ++k) stepper.step(world, 1.0 / 240.0);
    EXPECT_NEAR(world.motion[upper].position.y(), 0.8, 1e-3);
    EXPECT_LE(world.motion[upper].velocity.norm(), 1e-3);
}

TEST(ExactSolid, APlayingCardMayBeExactAlthoughNoFieldCouldResolveIt)
{
    const Vec3 card(0.0003, 0.088, 0.063);
    const TriMesh mesh = makeBox(card, {1, 4, 3});
    EXPECT_THROW(buildMeshShape("card", mesh), Error);  // 3520 voxels along it
    const auto shape = buildExactShape("card", ExactSolid::box(card), mesh);
    EXPECT_NEAR(shape->unitMass.volume, card.prod(), 1e-18);
}

}  // namespace
}  // namespace scree::test
