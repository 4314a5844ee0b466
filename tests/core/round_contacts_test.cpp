// Fine meshes touch where the smooth bodies they stand for would.  [A40; algorithm 14]
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kBulge = 4e-3;  // of a ball of 1280 triangles, as a share of its radius

std::shared_ptr<const Shape> meshedBall(double radius)
{
    return buildMeshShape("ball", makeSphere(radius, 3));
}

Vec3 signedUnits(std::uint64_t stream, std::uint64_t first)
{
    Vec3 v;
    for (std::uint64_t k = 0; k < 3; ++k)
        v[static_cast<int>(k)] = 2.0 * randomUnit(40, stream, first + k) - 1.0;
    return v;
}

std::vector<GapContact> contactsOf(const Shape& a, const Pose& worldFromA, const Shape& b,
                                   const Pose& worldFromB, double reach)
{
    std::vector<GapContact> contacts;
    NearFeatures().findContacts({&a, &b, worldFromA, worldFromB}, reach, contacts);
    return contacts;
}

const GapContact& nearestOf(const std::vector<GapContact>& contacts)
{
    return *std::min_element(
        contacts.begin(), contacts.end(),
        [](const GapContact& p, const GapContact& q) { return p.gap < q.gap; });
}

/// Largest change of the depth at which A touches B in one of many small steps along a line, as
/// shares of its size, on either side of where it begins.
double largestJump(const Shape& a, const Pose& worldFromA, const Shape& b, const Vec3& way)
{
    constexpr int kSteps = 200;
    const double size = a.boundingRadius;
    double largest = 0.0, before = 0.0;
    for (int k = -kSteps; k <= kSteps; ++k) {
        const Pose pose{worldFromA.position + k * size * way, worldFromA.orientation};
        const std::vector<GapContact> contacts =
            contactsOf(a, pose, b, {Vec3::Zero(), Quat::Identity()}, 0.02 * size);
        const double now = contacts.empty() ? 1.0 : nearestOf(contacts).gap / size;
        const bool isTouch = std::abs(now) < 2e-3 && std::abs(before) < 2e-3;
        if (k > -kSteps && isTouch) largest = std::max(largest, std::abs(now - before));
        before = now;
    }
    return largest;
}

/// Lowered until it touches what is in the origin.
Pose loweredOnto(const Shape& lower, const Shape& a, Pose worldFromA)
{
    double above = 4.0, below = 0.0;
    for (int i = 0; i < 50; ++i) {
        worldFromA.position.y() = 0.5 * (above + below);
        const std::vector<GapContact> contacts =
            contactsOf(a, worldFromA, lower, {Vec3::Zero(), Quat::Identity()}, 0.02);
        const bool touches = !contacts.empty() && nearestOf(contacts).gap < 0.0;
        (touches ? below : above) = worldFromA.position.y();
    }
    return worldFromA;
}

// An edge between two sides seen from aside was taken for a face, which went on beyond it: the rim
// was deeper below that than in either side. Or the rim was beside the edge on one of them with
// none of its corners, and was not told as deep as it was. These are the draws of five hundred in
// which that happened: the last three the second.
TEST(RoundContacts, ARimThatPassesAnEdgeBetweenTwoSidesIsAsDeepAsInThese)
{
    const auto shape = buildMeshShape("coin", makeCylinder(1.2, 0.2, 32, 1));
    // A coin that lies on its side, and others edge down on that, turned about the vertical.
    const Quat lying = exponentialMap(0.5 * kPi * Vec3::UnitX());
    const auto lower =
        buildMeshShape("lying", transformed(makeCylinder(1.2, 0.6, 32, 1), {Vec3::Zero(), lying}));
    for (const std::uint64_t draw : {50, 77, 217, 237, 315, 326, 330, 394, 399, 495, 25, 46, 225}) {
        const Quat orientation =
            exponentialMap(2.0 * kPi * randomUnit(43, draw, 0) * Vec3::UnitY()) *
            exponentialMap((0.5 * kPi + 0.2 * (randomUnit(43, draw, 1) - 0.5)) * Vec3::UnitX()) *
            exponentialMap(2.0 * kPi * randomUnit(43, draw, 2) * Vec3::UnitY());
        const double beside = 0.4 * (randomUnit(43, draw, 3) - 0.5);
        const Pose pose = loweredOnto(*lower, *shape, {Vec3(beside, 0.0, 0.0), orientation});
        const Vec3 way = Vec3(1.0, 0.02, 0.05).cwiseProduct(signedUnits(draw, 60)).normalized();
        EXPECT_LE(largestJump(*shape, pose, *lower, 5e-5 * way), 3e-4) << draw;
    }
}

/// A strip like the handle of a fork, along z: it bends up, then down. Its corners are where a file
/// of five decimals puts them.
std::shared_ptr<const Shape> wavyStrip()
{
    constexpr int kAcross = 4, kAlong = 50;
    constexpr double kStep = 0.35, kThick = 0.5;
    TriMesh mesh{Points(3, 2 * (kAcross + 1) * (kAlong + 1)),
                 Triangles(3, 4 * (kAcross * kAlong + kAcross + kAlong))};
    const auto vertex = [](int i, int j, int top) { return 2 * (j * (kAcross + 1) + i) + top; };
    for (int j = 0; j <= kAlong; ++j) {
        const double z = kStep * (j - 0.5 * kAlong);
        const double middle = 1e-5 * std::round(1e5 * 0.35 * std::cos(0.45 * z + 1.0));
        for (int i = 0; i <= kAcross; ++i) {
            for (const int top : {0, 1}) {
                mesh.points.col(vertex(i, j, top)) << kStep * (i - 0.5 * kAcross),
                    middle + kThick * (top - 0.5), z;
            }
        }
    }
    int triangle = 0;
    const auto quad = [&](int a, int b, int c, int d) {
        mesh.triangles.col(triangle++) << a, b, c;
        mesh.triangles.col(triangle++) << a, c, d;
    };
    for (int j = 0; j < kAlong; ++j) {
        for (int i = 0; i < kAcross; ++i) {
            quad(vertex(i, j, 1), vertex(i, j + 1, 1), vertex(i + 1, j + 1, 1),
                 vertex(i + 1, j, 1));
            quad(vertex(i, j, 0), vertex(i + 1, j, 0), vertex(i + 1, j + 1, 0),
                 vertex(i, j + 1, 0));
        }
        quad(vertex(0, j, 0), vertex(0, j + 1, 0), vertex(0, j + 1, 1), vertex(0, j, 1));
        quad(vertex(kAcross, j, 1), vertex(kAcross, j + 1, 1), vertex(kAcross, j + 1, 0),
             vertex(kAcross, j, 0));
    }
    for (int i = 0; i < kAcross; ++i) {
        quad(vertex(i, 0, 1), vertex(i + 1, 0, 1), vertex(i + 1, 0, 0), vertex(i, 0, 0));
        quad(vertex(i, kAlong, 0), vertex(i + 1, kAlong, 0), vertex(i + 1, kAlong, 1),
             vertex(i, kAlong, 1));
    }
    return buildMeshShape("strip", mesh);
}

// Where one lies in the other, the plane of a facet goes on for a good way close to the facets
// beside it. Two forks were told of overlap there that there was not, in one step but not the next.
TEST(RoundContacts, WavyStripsInEachOtherAreToldOfNoFacetBeyondItsEnd)
{
    const auto strip = wavyStrip();
    const Pose lower = inverse(strip->bodyFromAsset);
    const auto leastOfCorners = [&](const Pose& upper) {
        double least = 1.0;
        for (const Pose& pose : {inverse(lower) * upper, inverse(upper) * lower}) {
            for (const auto& point : strip->features.points().colwise())
                least = std::min(least, strip->distance.value(pose * Vec3(point)));
        }
        return least;
    };
    std::size_t rounded = 0, tooDeep = 0;
    for (std::uint64_t draw = 0; draw < 200; ++draw) {
        const Quat turn = exponentialMap(0.05 * signedUnits(draw, 3));
        const Vec3 aside = signedUnits(draw, 0);
        const auto at = [&](double y) {
            return Pose{Vec3(0.5 * aside.x(), y, 2.5 * aside.z()), turn} * lower;
        };
        double apart = 2.0, within = 0.2;
        for (int n = 0; n < 20; ++n) {
            const double middle = 0.5 * (apart + within);
            (leastOfCorners(at(middle)) > 0.0 ? apart : within) = middle;
        }
        const Pose upper = at(apart);
        for (const GapContact& contact : contactsOf(*strip, upper, *strip, lower, 0.02)) {
            if (kindOf(contact.feature) != FeatureKind::round) continue;
            const Vec3 onUpper = upper.position + contact.rA + 0.5 * contact.gap * contact.normal;
            if (std::abs(onUpper.z()) > 8.5) continue;  // across the ends
            const double value = strip->distance.value(inverse(lower) * onUpper);
            tooDeep += contact.gap < value - 1.2 * strip->bulge();
            ++rounded;
        }
    }
    EXPECT_GT(rounded, 150u);
    EXPECT_LE(tooDeep, 6u);  // at the rims; 101 of 420 once
}

// The place of a rock that faced the floor, by its normals, was not the lowest: the corner beside
// it sank into the floor.
TEST(RoundContacts, NoCornerOfARockIsLowerThanItIsToldToBe)
{
    TriMesh mesh = makeSphere(0.5, 2);
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v)
        mesh.points.col(v) *= 1.0 + 0.06 * randomUnit(42, 0, static_cast<std::uint64_t>(v));
    const auto rock = buildMeshShape("rock", mesh);
    ASSERT_FALSE(rock->roundFacets.isEmpty());
    World world;
    addPlane(world, addMaterial(world, 0.5, 0.0));
    const Shape& floor = world.shapeOf(0);
    std::size_t rounded = 0;
    for (std::uint64_t draw = 0; draw < 1000; ++draw) {
        Pose pose{Vec3::Zero(), exponentialMap(3.0 * signedUnits(draw, 0))};
        double lowest = 1.0;
        for (const auto& point : rock->features.points().colwise())
            lowest = std::min(lowest, (pose * Vec3(point)).y());
        pose.position.y() = -lowest;
        const auto contacts =
            contactsOf(*rock, pose, floor, {Vec3::Zero(), Quat::Identity()}, 0.01);
        ASSERT_FALSE(contacts.empty()) << draw;
        EXPECT_LE(nearestOf(contacts).gap, 1e-7) << draw;
        rounded += kindOf(nearestOf(contacts).feature) == FeatureKind::round;
    }
    EXPECT_GT(rounded, 100u);
}

// Told of facets, two such balls met off the line of centres by up to 4°, and the blow went aside.
TEST(RoundContacts, MeshedBallsTouchOnceOnTheLineOfTheirCentresHoweverTheyAreTurned)
{
    const auto large = meshedBall(1.0), small = meshedBall(0.6);
    for (std::uint64_t draw = 0; draw < 300; ++draw) {
        const Vec3 line = signedUnits(draw, 0).normalized();
        const double gap = 2e-3 * (randomUnit(41, draw, 0) - 0.5);
        const Pose a{(1.6 + gap) * line, exponentialMap(3.0 * signedUnits(draw, 3))};
        const Pose b{Vec3::Zero(), exponentialMap(3.0 * signedUnits(draw, 6))};
        const std::vector<GapContact> contacts = contactsOf(*small, a, *large, b, 2e-3);
        ASSERT_EQ(contacts.size(), 1u) << draw;
        EXPECT_LT((contacts[0].normal - line).norm(), 3e-3) << draw;
        EXPECT_NEAR(contacts[0].gap, gap, 5e-5) << draw;  // the facets lie up to 6e-3 below
        EXPECT_LT((contacts[0].rA + 0.6 * line).norm(), 3e-3) << draw;
    }
}

/// Of a capsule along y, or of a ball: the points that are nearer than the radius to its segment.
struct Stick {
    double radius, height;
    int sectors = 0, rings = 0;

    std::shared_ptr<const Shape> mesh() const
    {
        return buildMeshShape("stick", height > 0.0 ? makeCapsule(radius, height, sectors, rings)
                                                    : makeSphere(radius, 3));
    }
};

/// From the axis of B to that of A, where these are nearest.
Vec3 shortestBetween(const Stick& a, const Pose& worldFromA, const Stick& b, const Pose& worldFromB)
{
    const Vec3 u = a.height * (worldFromA.orientation * Vec3::UnitY());
    const Vec3 v = b.height * (worldFromB.orientation * Vec3::UnitY());
    const Vec3 apart = worldFromA.position - worldFromB.position;
    double s = 0.0, t = 0.0;  // places along the axes, from the middle, as shares of their lengths
    for (int i = 0; i < 200; ++i) {
        if (b.height > 0.0) t = std::clamp(v.dot(apart + s * u) / v.squaredNorm(), -0.5, 0.5);
        if (a.height > 0.0) s = std::clamp(u.dot(t * v - apart) / u.squaredNorm(), -0.5, 0.5);
    }
    return apart + s * u - t * v;
}

Pose bodyAt(const Shape& shape, const Pose& worldFromAsset)
{
    return worldFromAsset * inverse(shape.bodyFromAsset);
}

// Told of the facets of their sides, they met up to 10 degrees off, at up to ten places. An end
// that is within reach besides has a contact of its own.
TEST(RoundContacts, CapsulesAndBallsTouchOnTheLineBetweenTheirAxesAtSidesAndEnds)
{
    const std::vector<Stick> sticks{{0.5, 0.0}, {0.2, 1.0, 20, 5}, {0.5, 3.0, 48, 12}};
    std::vector<std::shared_ptr<const Shape>> shapes;
    for (const Stick& stick : sticks) shapes.push_back(stick.mesh());
    int apart = 0, several = 0;
    for (std::uint64_t draw = 0; draw < 600; ++draw) {
        const std::size_t i = draw % 3, j = 1 + draw / 3 % 2;
        const double gap = 2e-3 * randomUnit(42, draw, 0);
        const double reach = sticks[i].radius + sticks[j].radius;
        Pose a{3.0 * signedUnits(draw, 0), exponentialMap(3.0 * signedUnits(draw, 3))};
        const Pose b{Vec3::Zero(), exponentialMap(3.0 * signedUnits(draw, 6))};
        const Vec3 between = shortestBetween(sticks[i], a, sticks[j], b);
        if (between.norm() < reach) continue;
        ++apart;
        // The line between them stays where it is while they come together along it.
        const Vec3 line = between.normalized();
        a.position -= between - (reach + gap) * line;
        const std::vector<GapContact> contacts =
            contactsOf(*shapes[i], bodyAt(*shapes[i], a), *shapes[j], bodyAt(*shapes[j], b), 4e-3);
        ASSERT_FALSE(contacts.empty()) << draw;
        const GapContact& nearest = nearestOf(contacts);
        EXPECT_LT((nearest.normal - line).norm(), 1e-4) << draw;
        EXPECT_NEAR(nearest.gap, gap, 1e-6) << draw;
        several += contacts.size() > 1;
    }
    EXPECT_LE(several, 30);
    EXPECT_GE(apart, 500);
}

double distanceToBox(const Vec3& p, const Vec3& half)
{
    return (p.cwiseAbs() - half).cwiseMax(0.0).norm();
}

// The oracle is an exact ball at the same place.
TEST(RoundContacts, AMeshedBallTouchesFacesEdgesAndCornersOfABoxLikeABall)
{
    const auto meshed = meshedBall(0.5), exact = exactSphere(0.5);
    const auto box = buildMeshShape("box", makeBox({2.0, 1.0, 3.0}, {2, 1, 3}));
    const Vec3 half = box->box.max;
    int faces = 0, others = 0;
    for (std::uint64_t draw = 0; draw < 400; ++draw) {
        // From anywhere around, towards a place within the box or near its surface.
        const Vec3 outward = signedUnits(draw, 0).normalized();
        const Vec3 target = 0.95 * signedUnits(draw, 3).cwiseProduct(half);
        double far = 5.0, near = 0.0;
        for (int halving = 0; halving < 50; ++halving) {
            const double middle = 0.5 * (far + near);
            (distanceToBox(target + middle * outward, half) > 0.5 + 1e-3 ? far : near) = middle;
        }
        const Pose ball{target + far * outward, exponentialMap(3.0 * signedUnits(draw, 6))};
        const Pose unmoved{Vec3::Zero(), Quat::Identity()};
        const std::vector<GapContact> ofMesh = contactsOf(*meshed, ball, *box, unmoved, 5e-3);
        const std::vector<GapContact> ofBall = contactsOf(*exact, ball, *box, unmoved, 5e-3);
        ASSERT_FALSE(ofBall.empty()) << draw;
        ASSERT_FALSE(ofMesh.empty()) << draw;
        const GapContact asMesh = nearestOf(ofMesh), asBall = nearestOf(ofBall);
        EXPECT_NEAR(asMesh.gap, asBall.gap, 5e-5) << draw;
        EXPECT_LT((asMesh.normal - asBall.normal).norm(), 4e-3) << draw;
        EXPECT_LT((asMesh.rA - asBall.rA).norm(), 2e-3) << draw;
        ++(asBall.normal.cwiseAbs().maxCoeff() > 0.9999 ? faces : others);
    }
    EXPECT_GT(faces, 100);
    EXPECT_GT(others, 50);
}

TEST(RoundContacts, ATurningBallNeverLeavesTheFloorNorSinksIntoIt)
{
    const auto ball = meshedBall(1.0);
    const auto floor = buildPlaneShape("floor");
    double lowest = 1e300, highest = -1e300;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const Pose pose{Vec3(0.0, 1.0, 0.0),
                        exponentialMap(2e-3 * static_cast<double>(i) * Vec3(0.3, 0.2, 0.9))};
        const std::vector<GapContact> contacts =
            contactsOf(*ball, pose, *floor, {Vec3::Zero(), Quat::Identity()}, 1e-3);
        ASSERT_EQ(contacts.size(), 1u) << i;
        lowest = std::min(lowest, contacts[0].gap);
        highest = std::max(highest, contacts[0].gap);
    }
    EXPECT_GT(lowest, -0.01 * kBulge);
    EXPECT_LT(highest, 0.01 * kBulge);
}

/// Box of 2 m with rounded edges: every octant of a ball shifted outwards, and flat between.
TriMesh roundedBox(double radius)
{
    TriMesh mesh = makeBox({2.0, 2.0, 2.0}, {21, 21, 21});
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
        const Vec3 p = mesh.points.col(v);
        const Vec3 octant = p.cwiseSign();
        mesh.points.col(v) = radius * p.normalized() + (1.0 - radius) * octant;
    }
    return mesh;
}

TEST(RoundContacts, CoarseAndSharpShapesAreNotRoundAndFineOnesAre)
{
    const auto isRound = [](const TriMesh& mesh) {
        return !buildMeshShape("shape", mesh)->roundFacets.isEmpty();
    };
    EXPECT_FALSE(isRound(makeTorus(1.0, 0.25, {16, 10})));  // the rings of figure 1
    EXPECT_FALSE(isRound(makeCylinder(0.25, 8.0, 20, 21)));
    EXPECT_FALSE(isRound(makeBox(Vec3::Ones(), {4, 4, 4})));
    EXPECT_FALSE(isRound(makeSphere(1.0, 1)));
    EXPECT_TRUE(isRound(makeSphere(1.0, 3)));
    EXPECT_TRUE(isRound(makeTorus(1.0, 0.25, {64, 32})));
}

struct Scene {
    World world;
    BodyId body;
};

Scene onFloor(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Vec3& velocity,
              const Vec3& spin)
{
    Scene scene;
    const MaterialId material = addMaterial(scene.world, 0.8, 0.0);
    addPlane(scene.world, material);
    scene.body = addBody(scene.world, shape, material, pose, 2.0, velocity, spin);
    return scene;
}

/// Of its lowest point [m].
double heightOf(const World& world, BodyId body)
{
    double lowest = 1e300;
    const Points& points = world.shapeOf(body).mesh.points;
    for (Eigen::Index v = 0; v < points.cols(); ++v) {
        const Vec3 p = world.motion[body].worldFromBody() * points.col(v);
        lowest = std::min(lowest, p.y());
    }
    return lowest;
}

/// Of straight sides, open at its top; the horizontal thickness of its wall is the same all over.
TriMesh makeCup(int sectors)
{
    constexpr double kFoot = 0.0275, kSlope = 0.11, kHeight = 0.09, kWall = 0.006, kFloor = 0.006;
    const double foot = kFoot, brim = kFoot + kSlope * kHeight;
    const Eigen::Vector2d rings[] = {{foot, 0.0},
                                     {brim, kHeight},
                                     {brim - kWall, kHeight},
                                     {foot + kSlope * kFloor - kWall, kFloor}};
    TriMesh mesh;
    mesh.points.resize(3, 4 * sectors + 2);
    mesh.triangles.resize(3, 8 * sectors);
    const int below = 4 * sectors, above = below + 1;
    mesh.points.col(below) = Vec3::Zero();
    mesh.points.col(above) = Vec3(0.0, kFloor, 0.0);
    int count = 0;
    for (int i = 0; i < sectors; ++i) {
        const double angle = 2.0 * kPi * i / sectors;
        const int next = (i + 1) % sectors;
        const auto add = [&](int a, int b, int c) { mesh.triangles.col(count++) << a, b, c; };
        for (int ring = 0; ring < 4; ++ring) {
            const double radius = rings[ring].x();
            mesh.points.col(ring * sectors + i) =
                Vec3(radius * std::cos(angle), rings[ring].y(), -radius * std::sin(angle));
            if (ring == 3) continue;
            const int here = ring * sectors, upper = here + sectors;
            add(here + i, here + next, upper + next);
            add(here + i, upper + next, upper + i);
        }
        add(below, next, i);
        add(above, 3 * sectors + i, 3 * sectors + next);
    }
    return mesh;
}

// One of twenty sides floated 3 mm above the cup it stood in: round outside, hollow as drawn.
TEST(RoundContacts, CupsStandInEachOtherAsFarAsTheyFit)
{
    constexpr double kPitch = 0.006 / 0.11;
    for (const int sectors : {20, 32}) {
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.0);
        addPlane(world, material);
        const auto cup = buildMeshShape("cup" + std::to_string(sectors), makeCup(sectors));
        addBody(world, cup, material, Pose());
        const Vec3 above(0.0, kPitch + 0.001, 0.0);
        const BodyId body = addBody(world, cup, material, {above, Quat::Identity()});
        Stepper stepper(screeSettings());
        for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_NEAR(world.worldFromAsset(body).position.y(), kPitch, 2e-5) << sectors;
        EXPECT_TRUE(world.contactMemory.isAsleep(body)) << sectors;
    }
}

// The facets between the ring and the hollow are as round as those outside, every other of them,
// and an apple that stood there found its places now on these and now at the corners: it never came
// to rest.
TEST(RoundContacts, WhatStandsOnTheRingAroundAHollowComesToRest)
{
    struct Ring {
        std::array<int, 2> segments;
        double depth;  // of the hollow side of the tube, as a share of the other
    };
    for (const Ring& ring : {Ring{{28, 20}, 2.0}, Ring{{24, 16}, 1.5}}) {
        TriMesh mesh = makeTorus(1.0, 0.4, ring.segments);
        for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
            const double radius = std::hypot(mesh.points(0, v), mesh.points(2, v));
            if (radius >= 1.0) continue;
            const double share = (1.0 - ring.depth * (1.0 - radius)) / radius;
            mesh.points(0, v) *= share;
            mesh.points(2, v) *= share;
        }
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addPlane(world, material);
        const BodyId body = addBody(world, buildMeshShape("ring", mesh), material,
                                    {{0.0, 0.5, 0.0}, exponentialMap(Vec3(0.1, 0.0, 0.05))});
        Stepper stepper(screeSettings());
        for (int f = 0; f < 48; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_TRUE(world.contactMemory.isAsleep(body)) << ring.depth;
    }
}

TEST(RoundContacts, ABallOfTrianglesRollsOnAtItsSpeedAtAnyStep)
{
    for (const double rate : {24.0, 240.0}) {
        Scene scene = onFloor(meshedBall(0.5), {{0.0, 0.5, 0.0}, Quat::Identity()}, {2.0, 0.0, 0.0},
                              {0.0, 0.0, -4.0});
        Stepper stepper(screeSettings());
        for (int i = 0; i < 3.0 * rate; ++i) stepper.step(scene.world, 1.0 / rate);
        EXPECT_NEAR(scene.world.motion[scene.body].velocity.norm(), 2.0, 0.01) << rate;
        EXPECT_NEAR(scene.world.motion[scene.body].position.y(), 0.5, 0.01 * kBulge) << rate;
    }
}

/// Something long to lay as a rail, and how it lies on the ground with its top level.
struct Rail {
    std::shared_ptr<const Shape> shape;
    Quat worldFromRail;
};

// Between its rims a barrel was its facets: it hopped along rails, and of 2 m/s it had 0.9 after 3
// s.
TEST(RoundContacts, ABarrelRollsAlongRailsAsOnAFloor)
{
    const Quat alongX(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitZ()));
    const Quat alongZ(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
    const auto barrel = buildMeshShape("barrel", makeCylinder(0.3, 0.9, 32, 2));
    // Of four sides with a face on top, of 24, and of eight with an edge on top that bends by 45°.
    const std::array<Rail, 3> rails = {
        Rail{boxShape({0.2, 0.2, 8.0}, 1), Quat::Identity()},
        Rail{buildMeshShape("pole", makeCylinder(0.1, 8.0, 24, 1)), alongZ},
        Rail{buildMeshShape("ridge", makeCylinder(0.1, 7.0, 8, 1)), alongX * alongZ}};
    for (const Rail& rail : rails) {
        World world;
        const MaterialId material = addMaterial(world, 0.6, 0.0);
        for (const double side : {-0.3, 0.3}) {
            addBody(world, rail.shape, material, {{side, -0.1, 0.0}, rail.worldFromRail}, 0.0);
        }
        const BodyId body = addBody(world, barrel, material, {{0.0, 0.3, -3.0}, alongX}, 1.0,
                                    {0.0, 0.0, 2.0}, {2.0 / 0.3, 0.0, 0.0});
        Stepper stepper(screeSettings());
        for (int frame = 0; frame < 72; ++frame) {
            stepper.advanceFrame(world, 1.0 / 24.0);
            ASSERT_NEAR(world.motion[body].position.y(), 0.3, 1e-4) << rail.shape->name;
        }
        EXPECT_NEAR(world.motion[body].velocity.z(), 2.0, 0.01) << rail.shape->name;
        EXPECT_NEAR(world.motion[body].position.x(), 0.0, 0.01) << rail.shape->name;
    }
}

// The rim of either may touch a little past the end of the other, and the end that is nearer by a
// hair told for both.
TEST(RoundContacts, LogsThatLieAlongEachOtherTouchAtBothEnds)
{
    constexpr double kRadius = 0.2, kLength = 4.0;
    const auto log = buildMeshShape("log", makeCylinder(kRadius, kLength, 24, 8));
    const Quat lying = fromEulerXyz({0.5 * kPi, 0.0, 0.0});
    const Pose below{Vec3(0.0, kRadius, 0.0), lying};
    for (const double tilt : {1e-8, 1e-6, 1e-4}) {
        for (std::uint64_t k = 0; k < 100; ++k) {
            const Vec3 turn = tilt * signedUnits(6, 6 * k),
                       shift = tilt * signedUnits(6, 6 * k + 3);
            const Pose above{Vec3(0.0, 3.0 * kRadius, 0.0) + shift, exponentialMap(turn) * lying};
            double least = kLength, most = -kLength;  // along the upper log
            for (const GapContact& contact : contactsOf(*log, above, *log, below, 0.02)) {
                if (contact.gap > 4.0 * tilt * kLength) continue;
                const double along = contact.rA.dot(above.orientation * Vec3::UnitX());
                least = std::min(least, along);
                most = std::max(most, along);
            }
            EXPECT_LT(least, -0.48 * kLength) << tilt << " " << k;
            EXPECT_GT(most, 0.48 * kLength) << tilt << " " << k;
        }
    }
}

TEST(RoundContacts, ABoxWithRoundedEdgesLiesOnItsFlatFaceAndDoesNotRollOffIt)
{
    const auto box = buildMeshShape("box", roundedBox(0.2));
    Scene scene = onFloor(box, {{0.0, 1.02, 0.0}, exponentialMap(Vec3(0.01, 0.0, 0.02))},
                          {0.3, 0.0, 0.0}, Vec3::Zero());
    Stepper stepper(screeSettings());
    for (int i = 0; i < 96; ++i) stepper.step(scene.world, 1.0 / 48.0);
    EXPECT_LT(scene.world.motion[scene.body].velocity.norm(), 1e-3);
    EXPECT_LT(angularVelocityOf(scene.world, scene.body).norm(), 1e-3);
    EXPECT_LT(heightOf(scene.world, scene.body), 1e-3);
    EXPECT_GT(heightOf(scene.world, scene.body), -1e-3);
}

TEST(RoundContacts, ACapsuleThatLiesOnItsSideRollsOnAtItsSpeed)
{
    const auto capsule = buildMeshShape("capsule", makeCapsule(0.3, 2.0, 32, 8));
    // Its axis along z, level or so that one end lands after the other.
    for (const double tilt : {0.0, 2e-3}) {
        const Pose lying{{0.0, 0.3 + tilt, 0.0}, exponentialMap(Vec3(0.5 * kPi + tilt, 0.0, 0.0))};
        Scene scene = onFloor(capsule, lying, {1.5, 0.0, 0.0}, {0.0, 0.0, -5.0});
        Stepper stepper(screeSettings());
        for (int i = 0; i < 240; ++i) stepper.step(scene.world, 1.0 / 120.0);
        EXPECT_NEAR(scene.world.motion[scene.body].velocity.x(), 1.5, 0.015) << tilt;
        EXPECT_NEAR(scene.world.motion[scene.body].position.y(), 0.3, 3e-4) << tilt;
        EXPECT_LT(std::abs(scene.world.motion[scene.body].position.z()), 0.02) << tilt;
    }
}

TEST(RoundContacts, AnEggComesToRestOnItsSideWithoutHovering)
{
    TriMesh mesh = makeSphere(0.3, 4);
    mesh.points.row(0) *= 2.0;
    const auto egg = buildMeshShape("egg", mesh);
    World world;
    const MaterialId material =
        world.addMaterial({"egg", 1.0, 0.5, 0.2, RollingFriction{0.01, 0.01, 0.0, 0.0}});
    addPlane(world, material);
    const BodyId body =
        addBody(world, egg, material, {{0.0, 0.5, 0.0}, exponentialMap(Vec3(0.4, 0.1, 0.2))}, 1.0);
    Stepper stepper(screeSettings());
    for (int i = 0; i < 600; ++i) stepper.step(world, 1.0 / 96.0);
    EXPECT_LT(world.motion[body].velocity.norm(), 1e-3);
    EXPECT_GT(heightOf(world, body), -1e-4 * egg->boundingRadius);
    EXPECT_LT(heightOf(world, body), egg->roundFacets.bulge());
}

}  // namespace
}  // namespace scree::test
