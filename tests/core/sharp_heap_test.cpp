// A heap of what is hard on features: points, hollows, and edges sharper than square, in a bin that
// is one mesh. What overlaps must be told of, and little does.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

Pose poseOf(const World& world, BodyId body)
{
    return {world.motion[body].position, world.motion[body].orientation};
}

/// The deepest of all edges in other bodies, as a share of the smaller body's radius.
double deepestInHeap(const World& world)
{
    double deepest = 0.0;
    const auto bodies = static_cast<BodyId>(world.bodyCount());
    for (BodyId a = 0; a < bodies; ++a) {
        for (BodyId b = 0; b < bodies; ++b) {
            const Shape &shapeA = world.shapeOf(a), &shapeB = world.shapeOf(b);
            const Pose bFromA = inverse(poseOf(world, b)) * poseOf(world, a);
            const double reach = shapeA.boundingRadius + shapeB.boundingRadius;
            if (a == b || bFromA.position.norm() > reach) continue;
            const double smaller = std::min(shapeA.boundingRadius, shapeB.boundingRadius);
            deepest = std::min(deepest, deepestOfEdges(shapeA, shapeB, bFromA, 24) / smaller);
        }
    }
    return deepest;
}

/// Stars, prisms, splinters and angles, dealt by `seed`, fall into a bin: the report tells of what
/// overlaps, and nothing does by much.
void expectNoOverlapUntold(std::uint64_t seed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.4, 0.2, 1000.0);
    const BodyId bin = addBody(world, binShape(0.3, 1.2, 5), material, Pose{}, 0.0);
    world.mass[bin] = BodyMass{};
    const std::array shapes = {starShape(), prismShape(), splinterShape(), angleShape()};
    constexpr int kBodies = 40, kFrames = 72;
    for (int i = 0; i < kBodies; ++i) {
        const std::uint64_t draw = seed + static_cast<std::uint64_t>(i);
        const Vec3 place(0.35 * (2 * (i % 2) - 1), 0.6 + 0.72 * (i / 4),
                         0.35 * (i / 2 % 2 * 2 - 1));
        addBody(world, shapes[i % 4], material,
                {place + 0.03 * signedUnits(draw, 0), exponentialMap(3.0 * signedUnits(draw, 3))});
    }
    Stepper stepper(screeSettings());
    for (int frame = 0; frame < kFrames; ++frame) {
        const FrameReport report = stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_LT(report.sum.worstOverlapRatio, 0.02) << seed << ", " << frame;
        if (frame % 2 == 1) {
            EXPECT_GT(deepestInHeap(world), -0.02) << seed << ", " << frame;
        }
    }
}

// In those of the first and the last two prisms locked a seventh and a third of their size deep.
TEST(SharpHeap, WhatLiesInABinDoesNotOverlapUntold)
{
    for (const std::uint64_t seed : {1000, 2000, 5000, 8000, 21000}) expectNoOverlapUntold(seed);
}

}  // namespace
}  // namespace scree::test
