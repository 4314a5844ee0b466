// Mail, rings each through four others: what takes bodies for their hulls cannot hold it, and what
// lets them pass through each other loses rings.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kRadius = 0.01, kTube = 0.0017;  // [m]

/// How often, counted by direction, the middle of ring B's tube goes through ring A.
int linking(const Pose& a, const Pose& b)
{
    constexpr int kPieces = 96;
    const auto seen = [&](int piece) {
        const double angle = 2.0 * kPi * piece / kPieces;
        const Vec3 along(std::cos(angle), 0.0, std::sin(angle));
        return Vec3(a.orientation.conjugate() *
                    (b.position + kRadius * (b.orientation * along) - a.position));
    };
    int times = 0;
    for (int i = 0; i < kPieces; ++i) {
        const Vec3 from = seen(i), to = seen(i + 1);
        if ((from.y() < 0.0) == (to.y() < 0.0)) continue;
        const Vec3 crossing = from + from.y() / (from.y() - to.y()) * (to - from);
        if (crossing.norm() < kRadius) times += to.y() > from.y() ? 1 : -1;
    }
    return times;
}

std::set<std::pair<BodyId, BodyId>> linksOf(const World& world, const std::vector<BodyId>& rings)
{
    const auto assetOf = [&](BodyId ring) {
        return world.motion[ring].worldFromBody() * world.shapeOf(ring).bodyFromAsset;
    };
    std::set<std::pair<BodyId, BodyId>> links;
    for (const BodyId a : rings) {
        for (const BodyId b : rings) {
            if (a < b && linking(assetOf(a), assetOf(b)) != 0) links.insert({a, b});
        }
    }
    return links;
}

TEST(Mail, LetFallOnABallLosesNoRingAndLiesStill)
{
    constexpr int kColumns = 6, kRows = 16;
    World world;
    const MaterialId material = addMaterial(world, 0.3, 0.2, 7800.0);
    addPlane(world, material);
    addBody(world, exactSphere(0.03), material, {Vec3(0.0, 0.03, 0.0), Quat::Identity()}, 0.0);
    const auto shape = buildMeshShape("ring", makeTorus(kRadius, kTube, {24, 10}));
    std::vector<BodyId> rings;
    for (int row = 0; row < kRows; ++row) {
        const int odd = row % 2, columns = kColumns - odd;
        for (int column = 0; column < columns; ++column) {
            const Vec3 place(2.5 * kRadius * (column - 0.5 * (columns - 1)), 0.1,
                             0.7 * kRadius * (row - 0.5 * (kRows - 1)));
            const double tilt = (odd ? 35.0 : -35.0) * kPi / 180.0;
            rings.push_back(
                addBody(world, shape, material, {place, fromEulerXyz({tilt, 0.0, 0.0})}, 0.0045));
        }
    }
    const auto links = linksOf(world, rings);
    ASSERT_EQ(links.size(), 2u * (kRows - 1) * (kColumns - 1));
    Stepper stepper(screeSettings());
    for (int f = 0; f < 72; ++f) stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_EQ(linksOf(world, rings), links);
    for (const BodyId ring : rings) EXPECT_TRUE(world.contactMemory.isAsleep(ring)) << ring;
}

}  // namespace
}  // namespace scree::test
