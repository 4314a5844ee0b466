// A capsule against a mesh: its axis tells where it touches.  [A9]
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/collision/capsule_places.h"
#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/geometry/triangle_distance.h"
#include "core/math/rotation.h"
#include "tests/support/lying_capsule.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kRadius = 0.1, kHalf = 0.25;

std::shared_ptr<const Shape> capsule()
{
    static const auto shape = buildMeshShape("capsule", makeCapsule(kRadius, 2.0 * kHalf, 20, 5));
    return shape;
}

Pose lyingAt(const Vec3& position, const Vec3& direction)
{
    return lyingAlong(*capsule(), position, direction);
}

/// With a mesh that stands as it was made.
std::vector<GapContact> contactsOn(const Shape& mesh, const Pose& pose, double reach)
{
    std::vector<GapContact> contacts;
    NearFeatures().findContacts({capsule().get(), &mesh, pose, inverse(mesh.bodyFromAsset)}, reach,
                                contacts);
    return contacts;
}

double distanceTo(const TriMesh& mesh, const Vec3& p)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Vec3 closest = closestOnTriangle(p, cornersOf(mesh, static_cast<int>(t))).point;
        nearest = std::min(nearest, (closest - p).norm());
    }
    return nearest;
}

/// How far the axis is from the surface: the distance along it changes no faster than its place, so
/// that only pieces that may hold less than the best so far are halved again.
double axisToSurface(const TriMesh& mesh, const Vec3& from, const Vec3& to, double& best)
{
    const Vec3 middle = 0.5 * (from + to);
    const double here = distanceTo(mesh, middle), half = 0.5 * (to - from).norm();
    best = std::min(best, here);
    if (here - half < best - 1e-7) {
        axisToSurface(mesh, from, middle, best);
        axisToSurface(mesh, middle, to, best);
    }
    return best;
}

Vec3 drawnVector(std::uint64_t draw, std::uint64_t k)
{
    return Vec3(randomUnit(11, draw, k), randomUnit(11, draw, k + 1), randomUnit(11, draw, k + 2)) -
           Vec3::Constant(0.5);
}

// The oracle knows nothing of edges, corners or ends.
TEST(CapsulePlaces, TheNearestOfThemIsAsNearAsTheAxis)
{
    int between = 0, atEnds = 0, inside = 0;
    for (const auto& mesh : {boxShape({0.4, 0.3, 0.2}, 2), angleShape(), starShape()}) {
        for (std::uint64_t draw = 0; draw < 250; ++draw) {
            const Pose pose =
                lyingAt(1.1 * drawnVector(draw, 0), drawnVector(draw, 3).normalized());
            const RelativePair pair{*capsule(), *mesh, pose.orientation.toRotationMatrix(),
                                    pose.position};
            CapsulePlaces found;
            const auto apart = findCapsulePlaces(pair, 1.0, found);
            if (!apart) {
                ++inside;
                continue;
            }
            const Vec3 half = pair.rotation * capsule()->capsule.half;
            double best = 10.0;
            const double nearest =
                axisToSurface(mesh->mesh, pose.position - half, pose.position + half, best) -
                kRadius;
            EXPECT_NEAR(*apart, nearest, 1e-6) << mesh->name << ' ' << draw;
            const auto isNearest = [&](const auto& one) { return one.contact.gap == *apart; };
            const bool isBetween = std::ranges::any_of(found.between, isNearest);
            between += isBetween;
            atEnds += !isBetween;
            EXPECT_TRUE(isBetween || std::ranges::any_of(found.ofEnd[0], isNearest) ||
                        std::ranges::any_of(found.ofEnd[1], isNearest));
        }
    }
    EXPECT_GE(between, 100);
    EXPECT_GE(atEnds, 100);
    EXPECT_GE(inside, 50);
}

TEST(CapsulePlaces, NoneIsNearerThanTheyAreSaidToBeApart)
{
    const auto mesh = starShape();
    int apartOnes = 0;
    for (std::uint64_t draw = 0; draw < 200; ++draw) {
        const Pose pose = lyingAt(1.5 * drawnVector(draw, 0), drawnVector(draw, 3).normalized());
        std::vector<GapContact> contacts;
        const double apart = NearFeatures().findContacts(
            {capsule().get(), mesh.get(), pose, inverse(mesh->bodyFromAsset)}, 0.02, contacts);
        if (apart <= 0.0) continue;
        ++apartOnes;
        EXPECT_TRUE(contactsOn(*mesh, pose, apart - 1e-9).empty()) << draw;
    }
    EXPECT_GE(apartOnes, 50);
}

TEST(CapsulePlaces, OnAPlateItsEndsTouchAndAcrossABeamTwoEdgesDo)
{
    const Pose above = lyingAt({0.01, 0.1 + kRadius + 1e-3, 0.02}, Vec3::UnitX());
    for (const double width : {2.0, 0.3}) {
        const auto contacts = contactsOn(*boxShape({width, 0.2, 2.0}, 1), above, 5e-3);
        ASSERT_EQ(contacts.size(), 2u) << width;
        const double halfApart = std::min(kHalf, 0.5 * width);
        EXPECT_NEAR(std::abs(contacts[0].rA.x() - contacts[1].rA.x()), 2.0 * halfApart, 1e-9);
        for (const GapContact& contact : contacts) {
            EXPECT_NEAR(contact.gap, 1e-3, 1e-9) << width;
            EXPECT_NEAR(contact.normal.y(), 1.0, 1e-9) << width;
        }
        EXPECT_NE(contacts[0].feature, contacts[1].feature);
    }
}

TEST(CapsulePlaces, ItRollsOverSeamsAsOverAPlane)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addBody(world, boxShape({40.0, 1.0, 4.0}, 16), material,
            {Vec3(0.0, -0.5, 0.0), Quat::Identity()}, 0.0);
    const BodyId rolling =
        addBody(world, capsule(), material,
                lyingAt({-8.0, kRadius, 0.3}, Vec3::UnitZ()) * capsule()->bodyFromAsset, 1.0,
                Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, -2.0 / kRadius));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 96; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_NEAR(world.motion[rolling].position.x(), 0.0, 1e-6);
    EXPECT_NEAR(world.motion[rolling].position.y(), kRadius, 1e-6);
    EXPECT_NEAR(world.motion[rolling].position.z(), 0.3, 1e-6);
}

TEST(CapsulePlaces, AcrossTwoBeamsItComesToRestWhereItsRadiusSays)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.2);
    for (const double x : {-0.15, 0.15}) {
        addBody(world, boxShape({0.1, 0.2, 1.0}, 1), material,
                {Vec3(x, -0.1, 0.0), Quat::Identity()}, 0.0);
    }
    const BodyId above =
        addBody(world, capsule(), material,
                lyingAt({0.02, kRadius + 0.05, 0.0}, Vec3(1.0, 0.1, 0.0).normalized()) *
                    capsule()->bodyFromAsset);
    Stepper stepper(screeSettings());
    for (int f = 0; f < 72; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    const BodyMotion& motion = world.motion[above];
    EXPECT_NEAR(motion.position.y(), kRadius, 5e-4 * kRadius);
    EXPECT_TRUE(motion.velocity.isZero(0.0)) << motion.velocity.transpose();
}

// The facets of the ring lie up to 3 mm below the surface that they stand for.
TEST(CapsulePlaces, OnARoundMeshTheSmoothSurfaceTells)
{
    const double major = 0.5, minor = 0.15;
    const auto ring = buildMeshShape("ring", makeTorus(major, minor, {48, 24}));
    for (const double around : {0.0, 0.03, 0.065}) {
        const Vec3 outward(std::cos(around), 0.0, std::sin(around));
        for (const double turn : {0.0, 0.4, 0.8, 1.5}) {
            const Vec3 direction(std::cos(around + turn), 0.0, std::sin(around + turn));
            const Vec3 above(0.0, minor + kRadius + 1e-3, 0.0);
            const auto contacts =
                contactsOn(*ring, lyingAt(major * outward + above, direction), 1.2e-3);
            ASSERT_EQ(contacts.size(), 1u) << around << ' ' << turn;
            EXPECT_NEAR(contacts[0].gap, 1e-3, 2e-5) << around << ' ' << turn;
            EXPECT_GT(contacts[0].normal.y(), 0.9999) << around << ' ' << turn;
        }
    }
}

}  // namespace
}  // namespace scree::test
