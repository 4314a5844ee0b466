// Skip stamps change nothing but time.  [A15]
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Boxes of several forms dropped into a heap.
World makeDrop(std::uint64_t seed, int count)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < count; ++i) {
        const auto u = [&](std::uint64_t k) {
            return 2.0 * randomUnit(seed, static_cast<std::uint64_t>(i), k) - 1.0;
        };
        const Vec3 size = i % 2 ? Vec3(0.5, 0.5, 0.5) : Vec3(0.9, 0.3, 0.5);
        const Vec3 place(0.6 * (i % 3) + 0.1 * u(0), 0.8 + 0.9 * (i / 6),
                         0.7 * (i / 3 % 2) + 0.1 * u(1));
        addBody(world, boxShape(size, 2), material, {place, exponentialMap({u(2), u(3), u(4)})});
    }
    return world;
}

TEST(SkipStamps, ChangeNoBitOfATumblingHeap)
{
    World with = makeDrop(1, 12), without = with;
    StepSettings settings = experimentSettings();
    Stepper skipping(settings);
    settings.skipStamps = false;
    Stepper testing(settings);
    for (int f = 0; f < 16; ++f) {
        const auto a = skipping.advanceFrame(with, 1.0 / 24.0).stateHash;
        const auto b = testing.advanceFrame(without, 1.0 / 24.0).stateHash;
        ASSERT_EQ(a, b) << "frame " << f;
    }
}

}  // namespace
}  // namespace scree::test
