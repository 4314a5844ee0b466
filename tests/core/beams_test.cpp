// E23: edge against edge, where no vertex is near.  [A8]
#include <gtest/gtest.h>

#include <algorithm>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

struct Beams {
    World world;
    BodyId upper = 0;
};

/// Two beams of 12 triangles, 1 × 0.1 × 0.1 m, crossed at 90° and turned 45° about their own axes:
/// edge over edge, the upper one 5 cm above the static lower one.
Beams makeBeams(bool edgeSamples)
{
    ShapeSettings settings;
    settings.edgeSamples = edgeSamples;
    const auto beam = buildMeshShape("beam", makeBox({1.0, 0.1, 0.1}, {1, 1, 1}), settings);
    Beams scene;
    const MaterialId material = addMaterial(scene.world, 0.5, 0.0);
    const Quat onEdge = exponentialMap({kPi / 4.0, 0.0, 0.0});
    const Quat across = exponentialMap({0.0, kPi / 2.0, 0.0});
    const double halfDiagonal = 0.05 * std::sqrt(2.0);
    addBody(scene.world, beam, material, {Vec3::Zero(), onEdge}, 0.0);
    scene.upper = addBody(scene.world, beam, material,
                          {{0.0, 2.0 * halfDiagonal + 0.05, 0.0}, across * onEdge});
    return scene;
}

TEST(E23EdgeAgainstEdge, ACrossedBeamRestsOnTheEdgeOfAnother)
{
    Beams scene = makeBeams(true);
    Stepper stepper(experimentSettings());
    double deepest = 0.0;
    for (int frame = 0; frame < 48; ++frame) {
        deepest = std::max(deepest,
                           stepper.advanceFrame(scene.world, 1.0 / 24.0).sum.deepestAfterPushOut);
    }
    const BodyMotion& upper = scene.world.motion[scene.upper];
    EXPECT_LE(deepest, 1e-3);
    EXPECT_NEAR(upper.position.y(), 0.1 * std::sqrt(2.0), 1e-3);
    EXPECT_LE(upper.velocity.norm(), 1e-3);
}

TEST(E23EdgeAgainstEdge, WithVertexSamplesAloneItFallsThrough)
{
    Beams scene = makeBeams(false);
    Stepper stepper(experimentSettings());
    for (int frame = 0; frame < 48; ++frame) stepper.advanceFrame(scene.world, 1.0 / 24.0);
    EXPECT_LT(scene.world.motion[scene.upper].position.y(), -0.5);
}

}  // namespace
}  // namespace scree::test
