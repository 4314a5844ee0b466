// What is asked eight abreast in single precision, beside what is asked one by one in double: it
// may err to the safe side only, and by little.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/collision/edge_contacts.h"
#include "core/collision/edge_lanes.h"
#include "core/geometry/distance_lanes.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

TEST(SphereLaneTree, TellsAllThingsThatAreNearAndFewOthers)
{
    for (const std::uint64_t count : {1u, 7u, 8u, 9u, 64u, 65u, 500u}) {
        std::vector<Ball> things;
        for (std::uint64_t i = 0; i < count; ++i)
            things.push_back({signedUnits(i, 0), 0.1 * randomUnit(24, i)});
        const SphereLaneTree tree(things);
        std::size_t asked = 0;
        for (std::uint64_t query = 0; query < 20; ++query) {
            const Vec3 centre = signedUnits(query, 100);
            const double radius = 0.3;
            std::vector<std::uint32_t> near;
            tree.visit(
                [&](const SphereLanes& spheres) {
                    ++asked;
                    const FloatLanes3 to = spheres.centre - FloatLanes3::all(centre);
                    const FloatLanes far = spheres.radius + floatLanesOf(radius);
                    return bitsOf(dot(to, to) <= far * far);
                },
                [&](std::uint32_t thing, int) { near.push_back(thing); });
            std::sort(near.begin(), near.end());
            ASSERT_TRUE(std::adjacent_find(near.begin(), near.end()) == near.end());
            for (std::uint32_t i = 0; i < count; ++i) {
                const double apart = (things[i].centre - centre).norm() - things[i].radius - radius;
                const bool isTold = std::binary_search(near.begin(), near.end(), i);
                if (std::abs(apart) > 1e-5) {
                    ASSERT_EQ(isTold, apart < 0.0) << count << ' ' << i;
                }
            }
        }
        if (count == 500) {
            EXPECT_LT(asked, 20 * 500 / kFloatLanes / 2);
        }
    }
}

std::shared_ptr<const Shape> storedRing(FieldStorage storage)
{
    ShapeSettings settings;
    settings.resolution = 96;
    settings.storage = storage;
    return buildMeshShape("ring", makeTorus(1.0, 0.25, {24, 16}), settings);
}

/// `within`: how far below the truth the answer may be at this place [m].
template <class Within>
void expectLowerBounds(const SignedDistance& field, double from, const Within& within)
{
    const Mat3 rotation = exponentialMap(Vec3(0.4, -1.1, 0.7)).toRotationMatrix();
    const Vec3 translation(0.3, 0.1, -0.2);
    const DistanceLanes lanes(field, rotation, translation, from);
    for (std::uint64_t i = 0; i < 5000; ++i) {
        std::vector<Ball> spheres;
        for (std::uint64_t k = 0; k < kFloatLanes; ++k)
            spheres.push_back({from * signedUnits(i, 3 * k) / 1.8, 0.2 * randomUnit(25, i, k)});
        const SphereLanes eight = inLanes(spheres).front();
        const FloatLanes apart = lanes.apartAtLeast(eight);
        for (int k = 0; k < kFloatLanes; ++k) {
            const Vec3 p = rotation * spheres[k].centre + translation;
            const double truth = field.lowerBound(p) - spheres[k].radius;
            const double most = field.upperBound(p) - spheres[k].radius;
            ASSERT_LE(apart[k], most) << p.transpose();
            ASSERT_GE(apart[k], truth - within(p)) << p.transpose();
        }
    }
}

TEST(DistanceLanes, AreNeverFartherAndHardlyNearerThanTheFieldSays)
{
    for (const FieldStorage storage : {FieldStorage::dense, FieldStorage::bricks}) {
        const auto ring = storedRing(storage);
        const DistanceNodes& nodes = ring->distance.field().nodes;
        ASSERT_EQ(nodes.storage, storage);
        const auto within = [&](const Vec3& p) {
            const Aabb& domain = ring->distance.domain();
            const Vec3 inside = p.cwiseMax(domain.min).cwiseMin(domain.max);
            return 2.0 * nodes.blockOf(nodes.placeOf(inside).cell).slack + (p - inside).norm();
        };
        expectLowerBounds(ring->distance, 2.5, within);
    }
    const auto exact = [](const Vec3&) { return 3e-5; };
    expectLowerBounds(exactSphere(0.5)->distance, 2.5, exact);
    expectLowerBounds(buildPlaneShape("floor")->distance, 2.5, exact);
}

/// A small thing far from the origin of what it lies on: there single precision loses most.
TEST(DistanceLanes, FarFromTheOriginAreNeverFartherThanTheTruth)
{
    const auto floor = buildPlaneShape("floor");
    const Mat3 rotation = exponentialMap(Vec3(0.4, -1.1, 0.7)).toRotationMatrix();
    const Vec3 translation(100.05, 200.013, 30.0);
    const DistanceLanes lanes(floor->distance, rotation, translation, 1.0);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Vec3 p = 0.05 * signedUnits(i, 0);
        const double truth = (rotation * p + translation).y();
        const FloatLanes apart = lanes.apartAtLeast(inLanes({{{p, 0.0}}}).front());
        EXPECT_LE(apart[0], truth);
        EXPECT_GE(apart[0], truth - 1e-3);
    }
}

/// Which pairs of edges of two shapes mayFace passes before a motion, and which touch after it.
struct EdgesAsked {
    std::size_t asked = 0, passed = 0, touching = 0;
};

void askAboutEdges(const Shape& shape, const Shape& other, std::uint64_t run, EdgesAsked& count)
{
    const RelativePair then{shape, other,
                            exponentialMap(3.0 * signedUnits(run, 0)).toRotationMatrix(),
                            0.9 * signedUnits(run, 3)};
    const Vec3 turned = 0.05 * signedUnits(run, 6), moved = 0.05 * signedUnits(run, 9);
    RelativePair before = then;
    before.rotation = exponentialMap(turned).toRotationMatrix() * then.rotation;
    before.translation = then.translation + moved;
    const double reach = 0.1;
    const FacingReach facing{std::max(reach, deepestEdges(then)),
                             moved.norm() + turned.norm() * shape.boundingRadius + 1e-5,
                             turned.norm() + 1e-5};
    const std::vector<EdgeLine>&first = shape.features.lines(), &second = other.features.lines();
    EightEdges ofSecond;
    ofSecond.fill(&second.front());
    for (std::int32_t i = 0; i < std::ssize(first); ++i) {
        EightEdges ofFirst;
        ofFirst.fill(&first[i]);
        const FacingLanes edge =
            FacingLanes(ofFirst).placed(before.rotation, before.translation).all(0);
        for (std::int32_t j = 0; j < std::ssize(second); ++j) {
            const int lane = j % kFloatLanes;
            ofSecond[static_cast<std::size_t>(lane)] = &second[j];
            const bool mayTouch = mayFace(edge, FacingLanes(ofSecond), facing) >> lane & 1u;
            const FacedEdges faced = faceEdges(then, i, j, reach, 1e-3);
            const bool touches = faced.contact || faced.passing;
            EXPECT_TRUE(mayTouch || !touches) << run << ' ' << i << ' ' << j;
            count.touching += touches;
            count.passed += mayTouch;
            ++count.asked;
        }
    }
}

TEST(EdgeLanes, ThatComeToTouchMayFaceEachOtherBeforehand)
{
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const auto hatchet = buildMeshShape("prism", makeCylinder(0.6, 1.0, 3, 1));
    EdgesAsked count;
    for (std::uint64_t run = 0; run < 60; ++run)
        askAboutEdges(*ring, run % 2 == 0 ? *ring : *hatchet, run, count);
    EXPECT_GT(count.touching, 50u);
    EXPECT_LT(count.passed, count.asked / 20);
}

TEST(EdgeLanes, OfFineSurfacesFaceOnlyThoseTheyMayMeet)
{
    const auto hatchet = buildMeshShape("prism", makeCylinder(0.6, 1.0, 3, 1));
    const auto ball = buildMeshShape("ball", makeSphere(0.6, 2));
    EdgesAsked count;
    for (std::uint64_t run = 0; run < 40; ++run) {
        askAboutEdges(*ball, *hatchet, run, count);
        askAboutEdges(*hatchet, *ball, run, count);
    }
    for (std::uint64_t run = 0; run < 10; ++run) askAboutEdges(*ball, *ball, run, count);
    EXPECT_GT(count.touching, 150u);
    EXPECT_LT(count.passed, count.asked / 500);
}

}  // namespace
}  // namespace scree::test
