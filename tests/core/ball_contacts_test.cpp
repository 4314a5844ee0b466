// An exact ball against a mesh: it touches at every place that is near from its own side, and at no
// other.  [A9]
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/collision/near_features.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// A block with a right-angled groove along z: walls at 45° from its bottom at y = 0 up to ridges
/// at x = ±1, y = 1.
TriMesh groovedBlock()
{
    const double outline[5][2] = {{-1, -0.5}, {1, -0.5}, {1, 1}, {0, 0}, {-1, 1}};
    TriMesh mesh;
    mesh.points.resize(3, 10);
    for (int i = 0; i < 10; ++i) {
        mesh.points.col(i) = Vec3(outline[i % 5][0], outline[i % 5][1], i < 5 ? 1.5 : -1.5);
    }
    mesh.triangles.resize(3, 16);
    int face = 0;
    const auto add = [&](int a, int b, int c) { mesh.triangles.col(face++) << a, b, c; };
    for (int i = 0; i < 5; ++i) {
        const int next = (i + 1) % 5;
        add(i, i + 5, next + 5);
        add(i, next + 5, next);
    }
    for (const int i : {4, 0, 1}) {  // the outline is seen whole from the bottom of the groove
        const int next = (i + 1) % 5;
        add(3, i, next);
        add(8, next + 5, i + 5);
    }
    return mesh;
}

std::vector<GapContact> contactsOf(const World& world, BodyId a, BodyId b, double reach)
{
    std::vector<GapContact> contacts;
    NearFeatures().findContacts({&world.shapeOf(a), &world.shapeOf(b),
                                 world.motion[a].worldFromBody(), world.motion[b].worldFromBody()},
                                reach, contacts);
    return contacts;
}

/// Where the centre of a ball that lies in the groove is: on the walls, or on the ridges when it is
/// too large to reach them.
double heightInGroove(double radius)
{
    const double onWalls = std::sqrt(2.0) * radius;
    return onWalls <= 2.0 ? onWalls : 1.0 + std::sqrt(radius * radius - 1.0);
}

// Seen in shots/letters.toml: a ball on both legs of an R was held by one of them, and told of a
// gap that it did not have, because its centre was outside of the R's lattice.
TEST(BallContacts, ABallInAGrooveTouchesBothSidesAndRestsAtTheHeightTheyGive)
{
    for (const double radius : {0.4, 1.2, 2.0, 5.0}) {
        World world;
        const MaterialId material = addMaterial(world, 0.3, 0.0);
        const BodyId block = addBody(world, buildMeshShape("block", groovedBlock()), material,
                                     {Vec3::Zero(), Quat::Identity()}, 0.0);
        const double height = heightInGroove(radius);
        const BodyId ball = addBody(world, exactSphere(radius), material,
                                    {Vec3(0.0, height + 1e-3, 0.2), Quat::Identity()});

        const std::vector<GapContact> contacts = contactsOf(world, block, ball, 0.01 * radius);
        ASSERT_EQ(contacts.size(), 2u) << radius;
        for (const GapContact& contact : contacts) {
            // Into the block, and as deep as a millimetre of height is along the normal, to the
            // second order of it.
            const double slope = -contact.normal.y();
            EXPECT_GT(slope, 0.1);
            EXPECT_NEAR(contact.gap, 1e-3 * slope, 1e-6) << radius;
        }
        EXPECT_NEAR(contacts[0].normal.x(), -contacts[1].normal.x(), 1e-9) << radius;

        Stepper stepper(screeSettings());
        for (int f = 0; f < 24; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
        EXPECT_NEAR(world.motion[ball].position.y(), height, 1e-5) << radius;
        EXPECT_NEAR(world.motion[ball].position.x(), 0.0, 1e-5) << radius;
    }
}

TEST(BallContacts, ASeamIsNoPlaceOfItsOwn)
{
    // Over a plate of four by four squares, cut into triangles: above faces, seams and corners, and
    // past the rim, where the rim's edge and at last its corner are nearest.
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    const BodyId plate = addBody(world, boxShape({4.0, 0.2, 4.0}, 4), material,
                                 {Vec3::Zero(), Quat::Identity()}, 0.0);
    const BodyId ball =
        addBody(world, exactSphere(1.0), material, {Vec3::Zero(), Quat::Identity()});
    for (double x = 0.0; x < 2.5; x += 0.125) {
        for (double z = 0.0; z < 2.5; z += 0.125) {
            const Vec3 beyond(std::max(x - 2.0, 0.0), 0.0, std::max(z - 2.0, 0.0));
            const double above = std::sqrt(1.002 * 1.002 - beyond.squaredNorm());
            world.motion[ball].position = Vec3(x, 0.1 + above, z);
            const std::vector<GapContact> contacts = contactsOf(world, ball, plate, 0.01);
            ASSERT_EQ(contacts.size(), 1u) << x << ' ' << z;
            EXPECT_NEAR(contacts[0].gap, 0.002, 1e-12);
            EXPECT_NEAR(contacts[0].normal.y(), above / 1.002, 1e-12);
        }
    }
}

TEST(BallContacts, ABallRollsOverSeamsAsOverAPlane)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addBody(world, boxShape({40.0, 1.0, 4.0}, 16), material,
            {Vec3(0.0, -0.5, 0.0), Quat::Identity()}, 0.0);
    const BodyId ball =
        addBody(world, exactSphere(0.5), material, {Vec3(-8.0, 0.5, 0.3), Quat::Identity()}, 1.0,
                Vec3(4.0, 0.0, 0.1), Vec3(0.2, 0.0, -8.0));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 96; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_NEAR(world.motion[ball].position.x(), 8.0, 1e-6);
    EXPECT_NEAR(world.motion[ball].position.y(), 0.5, 1e-6);
    EXPECT_NEAR(world.motion[ball].position.z(), 0.7, 1e-6);
}

}  // namespace
}  // namespace scree::test
