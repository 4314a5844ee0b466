// Same scene, same bits, wherever between sub-steps it was cut in two. Threads, seeds and frames:
// scree verify E19.  [A21]
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Rings and cubes tumbling onto each other: islands, levels, edges and true normals all at work.
World makeTumble()
{
    static const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (std::uint64_t i = 0; i < 24; ++i) {
        const auto u = [&](std::uint64_t k) { return 2.0 * randomUnit(19, i, k) - 1.0; };
        const Vec3 place(2.2 * static_cast<double>(i % 3) + 0.3 * u(0),
                         1.6 + 1.1 * static_cast<double>(i / 3), 0.8 * u(1));
        addBody(world, i % 2 ? ring : boxShape(Vec3::Ones(), 2), material,
                {place, exponentialMap({u(2), u(3), u(4)})});
    }
    return world;
}

TEST(Determinism, StoppingBetweenSubStepsAndGoingOnElsewhereChangesNothing)
{
    World unbroken = makeTumble(), broken = makeTumble();
    Stepper stepper(experimentSettings());
    for (int f = 0; f < 20; ++f) stepper.advanceFrame(unbroken, 1.0 / 24.0);

    int stops = 0;
    while (broken.clock.frame < 20) {
        // Only what a checkpoint holds goes on: motion, order, clock, in a fresh world.
        World fresh = makeTumble();
        fresh.motion = broken.motion;
        fresh.order = broken.order;
        fresh.clock = broken.clock;
        broken = fresh;
        Stepper another(experimentSettings());
        stops += !another.advanceFrame(broken, 1.0 / 24.0, [] { return true; }).finished;
    }
    EXPECT_GT(stops, 20);
    EXPECT_EQ(stateHash(broken), stateHash(unbroken));
}

}  // namespace
}  // namespace scree::test
