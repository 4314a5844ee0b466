// Same scene, same bits, wherever between sub-steps it was cut in two. Threads, seeds and frames:
// scree verify E19.  [A21]
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/broken_run.h"
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

std::vector<std::uint64_t> hashes(World world, int frames, int threads,
                                  const StepSettings& settings = experimentSettings())
{
    setThreadCount(threads);
    Stepper stepper(settings);
    std::vector<std::uint64_t> result;
    for (int f = 0; f < frames; ++f) {
        result.push_back(stepper.advanceFrame(world, 1.0 / 24.0).stateHash);
    }
    setThreadCount(1);
    return result;
}

/// Round bodies, exact and meshed, whose samples move and whose rolling is braked.
World makeMarbles()
{
    const std::vector<std::shared_ptr<const Shape>> shapes = {
        exactSphere(0.4), exactCylinder(0.3, 0.8), exactBox({0.7, 0.5, 0.9}, 2),
        buildMeshShape("ball", makeSphere(0.4, 3))};
    World world;
    const MaterialId material =
        world.addMaterial({"felt", 1000.0, 0.5, 0.2, {0.01, 0.01, 0.0, 0.0}});
    addPlane(world, material);
    for (std::uint64_t i = 0; i < 24; ++i) {
        const auto u = [&](std::uint64_t k) { return 2.0 * randomUnit(20, i, k) - 1.0; };
        const Vec3 place(1.2 * static_cast<double>(i % 2) + 0.1 * u(0),
                         0.8 + 1.2 * static_cast<double>(i / 2), 0.1 * u(1));
        addBody(world, shapes[i % 4], material, {place, exponentialMap({u(2), u(3), u(4)})});
    }
    return world;
}

TEST(Determinism, MarblesAndCansFallToTheSameBitsOnAnyNumberOfThreadsAndOverlapLittle)
{
    const World world = makeMarbles();
    const auto once = hashes(world, 24, 1);
    EXPECT_EQ(hashes(world, 24, 3), once);
    World watched = world;
    Stepper stepper(experimentSettings());
    double worst = 0.0;
    for (int f = 0; f < 24; ++f) {
        worst = std::max(worst, stepper.advanceFrame(watched, 1.0 / 24.0).sum.worstOverlapRatio);
    }
    EXPECT_LE(worst, 0.02);
}

/// Cubes dropped in a block: one island of thousands of rows, which two threads share. What falls
/// fast is in for many blows.
World makeBlock(double restitution, double speed)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, restitution);
    addPlane(world, material);
    for (int i = 0; i < 216; ++i) {
        const Vec3 place(i % 6, 0.51 + 1.001 * (i / 36), i / 6 % 6);
        addBody(world, boxShape(Vec3::Ones(), 2), material, {place, Quat::Identity()}, 1.0,
                -speed * Vec3::UnitY());
    }
    return world;
}

TEST(Determinism, AnIslandThatThreadsShareHasTheBitsOfOneThread)
{
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    settings.sleep = false;
    for (const double restitution : {0.0, 0.4}) {
        const World world = makeBlock(restitution, 10.0 * restitution);
        const auto once = hashes(world, 6, 1, settings);
        EXPECT_EQ(hashes(world, 6, 2, settings), once);
        EXPECT_EQ(hashes(world, 6, 7, settings), once);

        World first = world;
        Stepper stepper(settings);
        const StepReport report = stepper.advanceFrame(first, 1.0 / 24.0).sum;
        EXPECT_GT(report.contacts, 1000);
        EXPECT_GE(report.collisionImpulses.total(), restitution > 0.0 ? 1000 : 0);
    }
}

TEST(Determinism, StoppingBetweenSubStepsAndGoingOnElsewhereChangesNothing)
{
    World unbroken = makeTumble();
    Stepper stepper(experimentSettings());
    for (int f = 0; f < 20; ++f) stepper.advanceFrame(unbroken, 1.0 / 24.0);

    int stops = 0;
    const World broken = runBroken(makeTumble, experimentSettings(), 20, stops);
    EXPECT_GT(stops, 20);
    EXPECT_EQ(stateHash(broken), stateHash(unbroken));
}

TEST(StateHash, TellsApartWhateverMoves)  // [A21]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    for (int i = 0; i < 2; ++i) addBody(world, boxShape(Vec3::Ones(), 1), material, {});
    world.births.resize(1);
    std::set<std::uint64_t> hashes = {stateHash(world)};
    const auto expectNew = [&](const char* what, const auto& change) {
        World other = world;
        change(other, other.motion[1]);
        EXPECT_TRUE(hashes.insert(stateHash(other)).second) << what;
    };
    expectNew("position", [](World&, BodyMotion& motion) { motion.position.z() = 1.0; });
    expectNew("orientation", [](World&, BodyMotion& motion) { motion.orientation.z() = 1.0; });
    expectNew("velocity", [](World&, BodyMotion& motion) { motion.velocity.z() = 1.0; });
    expectNew("spin", [](World&, BodyMotion& motion) { motion.angularMomentum.z() = 1.0; });
    expectNew("sign of zero", [](World&, BodyMotion& motion) { motion.velocity.x() = -0.0; });
    expectNew("order",
              [](World& other, BodyMotion&) { std::swap(other.order[0], other.order[1]); });
    expectNew("births", [](World& other, BodyMotion&) { other.bornAt[1] = 3; });
    expectNew("frame", [](World& other, BodyMotion&) { other.clock.frame = 1; });
    expectNew("sub-step", [](World& other, BodyMotion&) { other.clock.subStep = 1; });
    expectNew("time", [](World& other, BodyMotion&) { other.clock.frameTimeDone = 0.01; });
}

TEST(StateHash, TellsApartWhateverAStepReadsOfItsMemory)  // [A21]
{
    World world;
    addBody(world, boxShape(Vec3::Ones(), 1), addMaterial(world, 0.5, 0.0), {});
    world.contactMemory.contacts.resize(1);
    world.contactMemory.rest.resize(1);
    std::set<std::uint64_t> hashes = {stateHash(world)};
    const auto expectNew = [&](const char* what, const auto& change) {
        World other = world;
        change(other.contactMemory, other.contactMemory.contacts[0], other.contactMemory.rest[0]);
        EXPECT_TRUE(hashes.insert(stateHash(other)).second) << what;
    };
    expectNew("dt", [](auto& memory, auto&, auto&) { memory.dt = 0.01; });
    expectNew("body", [](auto&, auto& contact, auto&) { contact.b = 1; });
    expectNew("feature", [](auto&, auto& contact, auto&) { contact.feature = 7; });
    expectNew("place", [](auto&, auto& contact, auto&) { contact.place.z() = 1.0; });
    expectNew("force", [](auto&, auto& contact, auto&) { contact.force.z() = 1.0; });
    expectNew("couple", [](auto&, auto& contact, auto&) { contact.couple.z() = 1.0; });
    expectNew("still", [](auto&, auto&, auto& rest) { rest.still.position.z() = 1.0; });
    expectNew("nearby", [](auto&, auto&, auto& rest) { rest.nearby.orientation.z() = 1.0; });
    expectNew("frames", [](auto&, auto&, auto& rest) { rest.nearby.frames = 1; });
    expectNew("pull", [](auto&, auto&, auto& rest) { rest.pull.z() = 1.0; });
    expectNew("asleep", [](auto&, auto&, auto& rest) { rest.isAsleep = true; });
    expectNew("unbalanced", [](auto&, auto&, auto& rest) { rest.unbalancedFrames = 1; });
}

}  // namespace
}  // namespace scree::test
