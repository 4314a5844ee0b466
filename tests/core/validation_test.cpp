// The costly checks of core/base/check.h, which run in these tests.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/dynamics/contact_point.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Two cubes that touch face to face; the right one comes from the right.
struct Meeting {
    World world;
    PairRecord pair;
    ContactPoint contact;

    Meeting()
    {
        const MaterialId material = addMaterial(world, 0.5, 0.5);
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{0.0, 0.0, 0.0}, Quat::Identity()});
        addBody(world, boxShape(Vec3::Ones(), 2), material, {{1.0, 0.3, 0.0}, Quat::Identity()});
        world.motion[1].velocity = {-2.0, 0.0, 0.5};
        pair.bodies = {0, 1};
        pair.friction = 0.5;
        contact.sampleBody = 1;
        contact.fieldBody = 0;
        contact.rS = {-0.5, 0.2, 0.1};
        contact.rF = {0.5, 0.5, 0.1};
        contact.normal = Vec3::UnitX();
        contact.u = world.motion[1].velocity;
    }

    void apply()
    {
        const PlacedPair placed = placePair(world, pair.bodies);
        const auto inertiaOf = [&](BodyId body) {
            return passInertia(world.mass[body], world.motion[body].orientation);
        };
        const PairInertia inertia{inertiaOf(0).inverseInertia, inertiaOf(1).inverseInertia,
                                  inertiaOf(0), inertiaOf(1)};
        ImpulseCounts counts;
        applyContact(world, StepSettings(), pair, contact, {placed, placed, placed}, inertia, 0.5,
                     counts);
    }
};

TEST(Validation, AnImpulseKeepsWhatTwoBodiesHaveTogether)
{
    Meeting meeting;
    EXPECT_NO_THROW(meeting.apply());
    EXPECT_GT(meeting.world.motion[1].velocity.x(), -2.0);
}

TEST(Validation, AnImpulseThatActsAtTwoPlacesIsOurMistake)
{
    Meeting meeting;
    meeting.contact.rF.y() += 0.01;
    EXPECT_THROW(meeting.apply(), Error);
}

TEST(Validation, AContactPlacedInOtherFramesIsOurMistake)
{
    Meeting meeting;
    meeting.world.motion[1].position.y() += 0.01;
    EXPECT_THROW(meeting.apply(), Error);
}

}  // namespace
}  // namespace scree::test
