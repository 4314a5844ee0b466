// Fast against obvious: remembered samples against all samples.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/collision/interference.h"
#include "core/geometry/primitives.h"
#include "tests/support/draws.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

void expectSameTouches(std::vector<Touch> fast, std::vector<Touch> plain, const std::string& where)
{
    std::sort(fast.begin(), fast.end(), isDeeper);
    std::sort(plain.begin(), plain.end(), isDeeper);
    ASSERT_EQ(fast.size(), plain.size()) << where;
    for (std::size_t i = 0; i < fast.size(); ++i) {
        EXPECT_EQ(fast[i].phi, plain[i].phi) << where;
        EXPECT_EQ(fast[i].sample, plain[i].sample) << where;
        EXPECT_EQ(fast[i].sampleOnA, plain[i].sampleOnA) << where;
        EXPECT_EQ(fast[i].point, plain[i].point) << where;
    }
}

std::vector<Touch> touchesOf(const PlacedPair& pair, double tau)
{
    std::vector<Touch> touches;
    findTouchesPlainly(pair, tau, touches);
    return touches;
}

void expectDeepestOf(const PlacedPair& pair, double tau, const std::vector<Touch>& plain)
{
    const std::optional<Touch> deepest = deepestTouch(pair, tau);
    ASSERT_EQ(deepest.has_value(), !plain.empty());
    if (plain.empty()) return;
    expectSameTouches({*deepest}, {*std::min_element(plain.begin(), plain.end(), isDeeper)},
                      pair.shapeA->name + " in " + pair.shapeB->name);
}

TEST(Interference, RememberedSamplesGiveTheSameTouchesBitForBitAsAllSamples)  // [A7, A12, A13]
{
    const std::vector<std::shared_ptr<const Shape>> shapes = {
        buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10})), boxShape(Vec3::Ones(), 2),
        boxShape({1.5, 0.3, 0.4}, 1), buildMeshShape("ball", makeSphere(0.6, 2)),
        buildPlaneShape("plane")};
    int touching = 0;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Shape& a = *shapes[randomIndex(4, 32, i)];
        const Shape& b = *shapes[randomIndex(5, 33, i)];
        const Pose poseA{drawVector(i, 1, 0.8), exponentialMap(drawVector(i, 2, 3.0))};
        PlacedPair pair{
            &a, &b, poseA, {drawVector(i, 3, 0.8), exponentialMap(drawVector(i, 4, 3.0))}};
        const double tau = contourValue(a, b);
        Proximity proximity;
        proximity.setMargin(0.01);
        // Moves of all sizes: within what the proximity remembers, and beyond it.
        for (std::uint64_t move = 0; move < 24; ++move) {
            std::vector<Touch> fast, plain;
            proximity.findTouches(pair, tau, fast);
            findTouchesPlainly(pair, tau, plain);
            touching += !plain.empty();
            expectSameTouches(fast, plain,
                              a.name + " in " + b.name + ", case " + std::to_string(i));
            EXPECT_EQ(proximity.interferes(pair, tau), !plain.empty());
            if (move % 6 == 0) expectDeepestOf(pair, tau, plain);
            if (move % 6 == 3) expectDeepestOf(pair, tau - 0.02, touchesOf(pair, tau - 0.02));
            const double size = std::vector{1e-6, 1e-3, 4e-3, 0.02, 1e-4}[move % 5];
            pair.worldFromA.position += drawVector(i, 10 + move, size);
            pair.worldFromA.orientation =
                rotated(pair.worldFromA.orientation, drawVector(i, 20 + move, size));
        }
    }
    EXPECT_GT(touching, 3000);
}

TEST(Interference, AnEdgeAcrossAnEdgeIsFoundAtItsDeepestPoint)  // [A8]
{
    const auto beam = boxShape({1.0, 0.1, 0.1}, 1);
    const Quat onEdge = exponentialMap({kPi / 4.0, 0.0, 0.0});
    const Quat across = exponentialMap({0.0, kPi / 2.0, 0.0});
    const double depth = 0.004;
    const double height = 0.1 * std::sqrt(2.0) - depth;
    // Bodies' frames are principal: their long axis need not be the asset's.
    const auto place = [&](const Pose& worldFromAsset) {
        return worldFromAsset * inverse(beam->bodyFromAsset);
    };
    std::vector<Touch> touches;
    findTouchesPlainly({beam.get(), beam.get(), place({{0.0, height, 0.0}, across * onEdge}),
                        place({Vec3::Zero(), onEdge})},
                       1e-7, touches);
    ASSERT_FALSE(touches.empty());
    const Touch deepest = *std::min_element(touches.begin(), touches.end(), isDeeper);
    // Straight down the edge stands at 45° to both faces of the other: distance is depth / √2.
    EXPECT_NEAR(deepest.phi, -depth / std::sqrt(2.0), 1e-5);
}

/// Whether an edge of A, not one of its vertices, is found inside B.
bool findsAnEdgeOfA(const Shape& a, const Shape& b, const Pose& worldFromAssetA,
                    const Pose& worldFromAssetB)
{
    std::vector<Touch> touches;
    findTouchesPlainly({&a, &b, worldFromAssetA * inverse(a.bodyFromAsset),
                        worldFromAssetB * inverse(b.bodyFromAsset)},
                       1e-7, touches);
    return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
        return touch.sampleOnA && touch.sample >= a.samples.vertices.cols();
    });
}

TEST(Interference, AnEdgeShortAgainstTheFieldOfALargeBodyWasNeverSampled)  // [A8]
{
    // The edge of 0.2 m is two lattice steps long in this field; the search once began at the
    // second.
    const auto small = boxShape(Vec3::Constant(0.2), 1), large = boxShape({4.0, 1.0, 1.0}, 1);
    ASSERT_GT(0.2, 2.0 * large->distance.spacing());
    ASSERT_LT(0.2, 4.0 * large->distance.spacing());
    const Quat onEdge = exponentialMap({kPi / 4.0, 0.0, 0.0});
    const Quat across = exponentialMap({0.0, kPi / 2.0, 0.0});
    const double height = 0.6 * std::sqrt(2.0) - 0.03;
    EXPECT_TRUE(findsAnEdgeOfA(*small, *large, {{0.0, height, 0.0}, across * onEdge},
                               {Vec3::Zero(), onEdge}));
}

TEST(Interference, AnEdgeCutIntoABodyUnseenBesideAVertexThatJustTouchedIt)  // [A8]
{
    // A bar runs from half a millimetre above a cube's top face down through it and out of its
    // side.
    const auto cube = boxShape(Vec3::Ones(), 1);
    const Vec3 start(0.3, 0.5005, 0.0), end(0.8, 0.2, 0.0);
    const double length = (end - start).norm();
    const auto bar = boxShape({length, 0.1, 0.1}, 1);
    const double down = -arcTangent((start.y() - end.y()) / (end.x() - start.x()));
    const Quat turn = exponentialMap({0.0, 0.0, down});
    const Vec3 middle = 0.5 * (start + end) + turn * Vec3(0.0, 0.05, 0.0);
    EXPECT_TRUE(findsAnEdgeOfA(*bar, *cube, {middle, turn}, {}));
}

}  // namespace
}  // namespace scree::test
