// A blow that sends a body where nobody has looked.
#include "core/dynamics/gaps/gap_unseen.h"

#include <gtest/gtest.h>

#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

// What counts is how large the smaller of two is: a slab of ten metres that strays by 6 mm has not
// strayed by a thousandth of its own size, and ran 5 mm into a pebble of 4 cm.
TEST(GapUnseen, AStruckSlabThatStraysByLittleOfItsSizeIsSeenByAPebble)
{
    constexpr double kStep = 1.0 / 24.0, kPebble = 0.04;
    StepSettings settings = screeSettings();
    settings.gravity = Vec3::Zero();
    // In its box, and farther away than that reaches.
    for (const double apart : {1e-3, 3e-3}) {
        SCOPED_TRACE(apart);
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.0);
        const BodyId slab =
            addBody(world, boxShape({10.0, 1.0, 10.0}, 1), material, {Vec3::Zero()}, 1e5);
        const BodyId pebble = addBody(world, boxShape(Vec3::Constant(kPebble), 1), material,
                                      {Vec3(0.0, 0.5 + apart + 0.5 * kPebble, 0.0)}, 0.064);
        addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3(0.0, -1.01, 0.0)}, 1000.0,
                {0.0, 15.0, 0.0});
        Stepper stepper(settings);
        for (int k = 0; k < 6; ++k)
            ASSERT_LT(stepper.step(world, kStep).deepestBeforePushOut, 2e-3 * kPebble)
                << "step " << k;
        const double speed = world.motion[slab].velocity.y();
        EXPECT_NEAR(speed, 15.0 / 101.0, 1e-3);
        EXPECT_NEAR(world.motion[pebble].velocity.y(), speed, 1e-3);
    }
}

}  // namespace
}  // namespace scree::test
