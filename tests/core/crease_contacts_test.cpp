// What lies in the crease between the floor and the walls of a bin, which is one mesh.
#include "core/collision/crease_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// Contacts of a box, A, that stands at `place` in a bin.
std::vector<GapContact> contactsInBin(const Shape& box, const Shape& bin, const Vec3& place)
{
    const Pose stands{place, Quat::Identity()};
    std::vector<GapContact> contacts;
    NearFeatures().findContacts(
        {&box, &bin, stands * inverse(box.bodyFromAsset), inverse(bin.bodyFromAsset)}, 0.01,
        contacts);
    return contacts;
}

bool anyAlong(const std::vector<GapContact>& contacts, const Vec3& normal)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const GapContact& contact) { return contact.normal.dot(normal) > 0.9; });
}

TEST(CreaseContacts, ACornerBetweenFloorAndWallTouchesBoth)
{
    constexpr double kSize = 0.2, kThick = 0.02, kHeight = 0.5;
    const auto box = boxShape({kSize, kThick, kSize}, 1);
    for (const double flare : {-0.05, 0.0, 0.1, 0.4}) {
        const auto bin = binShape(flare, kHeight);
        const Vec3 wall = Vec3(-kHeight, flare, 0.0).normalized();
        // Before both, before one, behind both.
        for (const auto& [overFloor, fromCrease] :
             {std::pair(0.001, 0.004), {0.003, 0.003}, {-2e-4, 0.004}, {-5e-4, -1e-4}}) {
            if (flare < 0.0 && fromCrease < 0.0) continue;  // its upper corners would be inside
            const Vec3 corner(kBinHalf - fromCrease, overFloor, 0.0);
            const auto contacts =
                contactsInBin(*box, *bin, corner + Vec3(-0.5 * kSize, 0.5 * kThick, 0.0));
            int onFloor = 0, onWall = 0;
            for (const GapContact& contact : contacts) {
                if (contact.rA.y() > 0.0) continue;
                if (contact.normal.dot(Vec3::UnitY()) > 0.999) {
                    EXPECT_NEAR(contact.gap, overFloor, 1e-6);
                    ++onFloor;
                } else if (contact.normal.dot(wall) > 0.999) {
                    EXPECT_NEAR(contact.gap, wall.dot(corner - Vec3(kBinHalf, 0.0, 0.0)), 1e-6);
                    ++onWall;
                }
            }
            EXPECT_EQ(onFloor, 4) << flare << ' ' << fromCrease;
            EXPECT_EQ(onWall, 2) << flare << ' ' << fromCrease;
        }
    }
}

TEST(CreaseContacts, ALedgeIsNoWallForWhatIsAboveIt)
{
    constexpr double kLedge = 0.005;
    const auto box = boxShape(Vec3::Constant(0.2), 1);
    const auto bin = binShape(0.0, kLedge);
    // Before the ledge, lower and higher than it; and on it, with one corner still behind it.
    for (const auto& [fromLedge, overFloor] :
         {std::pair(0.002, 0.001), {0.002, 0.008}, {-0.01, 0.006}}) {
        const auto contacts =
            contactsInBin(*box, *bin, {kBinHalf - fromLedge - 0.1, 0.1 + overFloor, 0.0});
        EXPECT_EQ(anyAlong(contacts, -Vec3::UnitX()), overFloor < kLedge) << overFloor;
    }
}

TEST(CreaseContacts, WallsThatMeetEndWithTheirCrease)
{
    constexpr double kHeight = 0.3;
    const auto bin = binShape(0.0, kHeight, 6);
    const auto box = boxShape(Vec3::Constant(0.1), 1);
    // A corner a millimetre from the first wall, five from where the second meets it.
    const double halfWall = kBinHalf * std::tan(kPi / 6.0);
    const Vec3 second = Vec3(-std::cos(kPi / 3.0), 0.0, std::sin(kPi / 3.0));
    for (const double overRim : {-0.05, 0.002}) {
        const Vec3 corner(kBinHalf - 0.001, kHeight + overRim, -(halfWall - 0.005));
        const auto contacts = contactsInBin(*box, *bin, corner + Vec3(-0.05, 0.05, 0.05));
        EXPECT_EQ(anyAlong(contacts, second), overRim < 0.0) << overRim;
    }
}

// A slab on the floor was told of the wall when it was deeper in that than in the floor: by 4 mm
// where it met the wall flush, by 23 mm with a corner.
TEST(CreaseContacts, ASlabThatSlidesOverTheFloorStopsAtTheWall)
{
    struct Slide {
        double flare, thick, turned;
    };
    for (const auto& [flare, thick, turned] : {Slide{0.1, 0.02, 0.0}, {0.3, 0.1, 0.3}}) {
        World world;
        const MaterialId material = addMaterial(world, 0.1, 0.0);
        const auto bin = binShape(flare, 0.5);
        const BodyId fixed = addBody(world, bin, material, Pose{}, 0.0);
        world.mass[fixed] = BodyMass{};
        const Quat turn(Eigen::AngleAxisd(turned, Vec3::UnitY()));
        const BodyId slab = addBody(world, boxShape({0.4, thick, 0.4}, 1), material,
                                    {Vec3(0.0, 0.5 * thick, 0.0), turn}, 1.0, 3.0 * Vec3::UnitX());
        double deepest = 0.0, farthest = 0.0;
        Stepper stepper(screeSettings());
        const auto look = [&](const World& now, double) {
            const auto poseOf = [&](BodyId body) {
                return Pose{now.motion[body].position, now.motion[body].orientation};
            };
            const Pose binFromSlab = inverse(poseOf(fixed)) * poseOf(slab);
            const ContactFeatures& features = now.shapeOf(slab).features;
            for (const std::int32_t corner : features.corners()) {
                const Vec3 place = binFromSlab * Vec3(features.points().col(corner));
                deepest = std::min(deepest, bin->distance.value(place));
            }
            farthest = std::max(farthest, now.motion[slab].position.x());
        };
        for (int frame = 0; frame < 24; ++frame) stepper.advanceFrame(world, 1.0 / 24.0, {}, look);
        EXPECT_GT(farthest, 0.25);  // it has met the wall
        EXPECT_GT(deepest, -1e-4) << flare;
    }
}

}  // namespace
}  // namespace scree::test
