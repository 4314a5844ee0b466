// Bodies that nobody would put together: any solids of any size and weight, rough or smooth, thrown
// onto a heap that may be pushed about. What is not solid there, or makes energy of nothing, is
// found sooner than in scenes made to be looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kFrame = 1.0 / 24.0;
constexpr int kFrames = 48;

std::shared_ptr<const Shape> drawSolid(Draw& draw)
{
    const double a = draw.magnitude(0.03, 0.3), b = draw.magnitude(0.03, 0.3);
    switch (draw.below(8)) {
        case 0:
            return exactSphere(a);
        case 1:
            return exactBox({a, b, draw.magnitude(0.03, 0.3)}, 2);
        case 2:
            return buildMeshShape("cylinder", makeCylinder(a, b, 32, 1));
        case 3:
            return buildMeshShape("capsule", makeCapsule(a, b, 24, 6));
        case 4:
            return buildMeshShape("ring", makeTorus(a, 0.3 * a, {24, 10}));
        case 5:
            return buildMeshShape("box", makeBox({a, b, draw.magnitude(0.01, 0.3)}, {1, 1, 1}));
        case 6:
            return draw.below(2) == 0 ? starShape() : angleShape();
        default:
            return draw.below(2) == 0 ? prismShape() : splinterShape();
    }
}

struct RandomScene {
    World world;
    bool isDriven;
};

RandomScene makeScene(std::uint64_t number)
{
    Draw draw(31, number);
    RandomScene scene;
    World& world = scene.world;
    const int script = draw.below(3);
    scene.isDriven = script > 0;
    // What is rougher jams between a pusher and the ground, and then no motion is right.
    const int roughest = scene.isDriven ? 3 : 5;
    std::vector<MaterialId> materials;
    for (int i = 0; i < 3; ++i) {
        const double friction = std::array{0.0, 0.1, 0.3, 0.6, 1.0}[draw.below(roughest)];
        const double restitution = draw.of(std::array{0.0, 0.0, 0.2, 0.5, 0.8});
        const double rolling = draw.below(3) == 0 ? draw.magnitude(1e-4, 1e-2) : 0.0;
        materials.push_back(
            world.addMaterial({"random", 1.0, friction, restitution, {.rolling = rolling}}));
    }
    addPlane(world, materials[0]);
    std::vector<std::shared_ptr<const Shape>> solids;
    for (int i = 0; i < 4; ++i) solids.push_back(drawSolid(draw));
    const int count = 8 + draw.below(25);
    double height = 0.05;
    for (int i = 0; i < count; ++i) {
        const auto& solid = draw.of(solids);
        height += solid->boundingRadius;
        const Vec3 place{draw.between(-0.2, 0.2), height, draw.between(-0.2, 0.2)};
        const Vec3 velocity = draw.below(8) == 0 ? draw.vector(4.0) : Vec3::Zero();
        const Vec3 spin = draw.below(8) == 0 ? draw.vector(20.0) : Vec3::Zero();
        const MaterialId material = draw.of(materials);
        const double mass = draw.magnitude(0.002, 500.0);
        addBody(world, solid, material, {place, exponentialMap(draw.vector(2.0))}, mass, velocity,
                spin);
        height += solid->boundingRadius;
    }
    const auto at = [](double x, double turn) {
        return Pose{{x, 0.3, 0.0}, exponentialMap({0.0, turn, 0.0})};
    };
    if (script == 1) {
        addKeyedBody(world, boxShape({0.1, 0.5, 1.0}, 1), draw.of(materials),
                     {{0.0, at(-1.5, 0.0)}, {0.6, at(-1.5, 0.0)}, {1.8, at(0.5, 0.0)}},
                     KeyInterpolation::smooth);
    } else if (script == 2) {
        addKeyedBody(world, boxShape({1.2, 0.1, 0.1}, 1), draw.of(materials),
                     {{0.0, at(3.0, 0.0)}, {0.8, at(0.8, 1.5)}, {2.0, at(0.0, 4.5)}},
                     KeyInterpolation::smooth);
    }
    return scene;
}

// The long form, from 0: SCREE_RANDOM_SCENES=2000 build/scree_core_tests --gtest_filter='Random*'
// The short one has 589 in it, where 56 kJ were a megajoule while weights that were none were
// handed down.
TEST(RandomScenes, NothingGoesThroughAnythingAndNoEnergyComesOfNothing)
{
    const char* wanted = std::getenv("SCREE_RANDOM_SCENES");
    const std::uint64_t first = wanted ? 0 : 580;
    const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 24;
    for (std::uint64_t number = first; number < first + count; ++number) {
        RandomScene scene = makeScene(number);
        const StepSettings settings = screeSettings();
        Stepper stepper(settings);
        const double atFirst = mechanicalEnergy(scene.world, settings.gravity);
        double before = atFirst, gained = 0.0, deepest = 0.0;
        for (int frame = 0; frame < kFrames; ++frame) {
            const StepReport sum = stepper.advanceFrame(scene.world, kFrame).sum;
            EXPECT_TRUE(sum.nonFinite.empty()) << number;
            if (!sum.nonFinite.empty()) break;  // the other scenes still tell
            const double after = mechanicalEnergy(scene.world, settings.gravity);
            gained += std::max(after - before - std::max(sum.pushOutWork, 0.0), 0.0);
            before = after;
            deepest = std::max(deepest, sum.worstOverlapRatio);
        }
        EXPECT_LT(deepest, 0.1) << number;
        if (scene.isDriven) continue;
        EXPECT_LE(gained, 0.01 * atFirst) << number;
    }
}

}  // namespace
}  // namespace scree::test
