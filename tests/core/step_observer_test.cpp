// What an observer is shown must account for what the step did, and showing it must not change it.
#include <gtest/gtest.h>

#include <vector>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/diagnostics/state_hash.h"
#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 48.0;

StepSettings settingsOf(Method method)
{
    StepSettings settings = experimentSettings();
    settings.method = method;
    return settings;
}

/// Boxes that land on the ground and on each other.
World makeLanding()
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (std::uint64_t i = 0; i < 12; ++i) {
        const auto u = [&](std::uint64_t k) { return 2.0 * randomUnit(23, i, k) - 1.0; };
        const Vec3 place(1.1 * static_cast<double>(i % 3), 0.9 + 1.3 * static_cast<double>(i / 3),
                         0.3 * u(0));
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {place, exponentialMap({0.4 * u(1), 0.4 * u(2), 0.4 * u(3)})}, 1.0 + 0.1 * i,
                {0.0, -2.0, 0.0});
    }
    return world;
}

class BothMethods : public testing::TestWithParam<Method> {};

// One sign rule: A receives +j and B −j.  [A0]
TEST_P(BothMethods, TheImpulsesShownAreAllThatChangedTheVelocities)
{
    World world = makeLanding();
    StepSettings settings = settingsOf(GetParam());
    settings.shockPropagation = false;  // its impulses act on the upper body alone
    Stepper stepper(settings);
    LastStep observer;
    stepper.observe(&observer);
    std::size_t contacts = 0;
    for (int s = 0; s < 40; ++s) {
        const std::vector<BodyMotion> before = world.motion;
        stepper.step(world, kDt);
        contacts += observer.seen.contacts.size();
        std::vector<Vec3> impulse(world.bodyCount(), Vec3::Zero());
        for (const ContactSeen& contact : observer.seen.contacts) {
            EXPECT_LT(contact.a, contact.b);
            EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
            impulse[contact.a] += contact.impulse;
            impulse[contact.b] -= contact.impulse;
        }
        for (std::size_t b = 0; b < world.bodyCount(); ++b) {
            if (!world.mass[b].isMovable()) continue;
            const Vec3 change = world.motion[b].velocity - before[b].velocity;
            const Vec3 fromContacts = (change - kDt * settings.gravity) / world.mass[b].inverseMass;
            // Sums of some hundred impulses of up to 10 N s in another order: rounding alone.
            EXPECT_LT((impulse[b] - fromContacts).norm(), 1e-9) << "body " << b << " step " << s;
        }
    }
    EXPECT_GT(contacts, 400U) << "too little happened to say anything";
}

TEST_P(BothMethods, WatchingChangesNoBitAndWhatIsSeenDependsOnNoThreads)
{
    const auto run = [&](bool isWatched, int threads, std::vector<StepSeen>& seen) {
        setThreadCount(threads);
        World world = makeLanding();
        Stepper stepper(settingsOf(GetParam()));
        LastStep observer;
        if (isWatched) stepper.observe(&observer);
        for (int s = 0; s < 30; ++s) {
            stepper.step(world, kDt);
            seen.push_back(observer.seen);
        }
        setThreadCount(1);
        return stateHash(world);
    };
    std::vector<StepSeen> none, one, three;
    const std::uint64_t hash = run(false, 1, none);
    EXPECT_EQ(run(true, 1, one), hash);
    EXPECT_EQ(run(true, 3, three), hash);
    for (std::size_t s = 0; s < one.size(); ++s) {
        EXPECT_EQ(one[s].level, three[s].level);
        EXPECT_EQ(one[s].overlap, three[s].overlap);
        ASSERT_EQ(one[s].contacts.size(), three[s].contacts.size());
        for (std::size_t c = 0; c < one[s].contacts.size(); ++c) {
            EXPECT_EQ(one[s].contacts[c].a, three[s].contacts[c].a);
            EXPECT_EQ(one[s].contacts[c].b, three[s].contacts[c].b);
            EXPECT_EQ(one[s].contacts[c].point, three[s].contacts[c].point);
            EXPECT_EQ(one[s].contacts[c].impulse, three[s].contacts[c].impulse);
        }
    }
}

TEST_P(BothMethods, AStackShowsItsLevelsAndItsContactsCarryWhatLiesAbove)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    for (int i = 0; i < 3; ++i) {
        // Each stands well inside the top of the one below: corner on corner has no normal.
        addBody(world, boxShape(Vec3(2.0 - 0.5 * i, 1.0, 2.0 - 0.5 * i), 2), material,
                {Vec3(0.0, 0.5 + i, 0.0)}, 2.0);
    }
    const StepSettings settings = settingsOf(GetParam());
    Stepper stepper(settings);
    LastStep observer;
    stepper.observe(&observer);
    for (int s = 0; s < 10; ++s) stepper.step(world, kDt);
    EXPECT_EQ(observer.seen.level, (std::vector<std::int32_t>{0, 1, 2, 3}));
    EXPECT_EQ(observer.seen.dt, kDt);
    std::vector<double> carried(world.bodyCount(), 0.0);
    for (const ContactSeen& contact : observer.seen.contacts) {
        EXPECT_EQ(contact.b, contact.a + 1);
        EXPECT_GT(-contact.normal.y(), 0.99) << "B lies above A: the normal points down to A";
        EXPECT_NEAR(contact.point.y(), contact.a, 0.01);
        carried[contact.a] -= contact.impulse.y();
    }
    // The method decides how well a stack is held within one step, not the observer: 5 %. With the
    // paper's shock only the top box is certain to feel no more than its own weight from below.
    const double weight = 2.0 * settings.gravity.norm() * kDt;
    EXPECT_NEAR(carried[2], weight, 0.05 * weight);
    if (GetParam() == Method::paper) return;
    EXPECT_NEAR(carried[1], 2.0 * weight, 0.05 * weight);
    EXPECT_NEAR(carried[0], 3.0 * weight, 0.05 * weight);
}

TEST_P(BothMethods, ABoxSunkIntoTheGroundIsShownAsDeepAsItIs)
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3(0.0, 0.48, 0.0)});
    addBody(world, boxShape(Vec3::Ones(), 1), material, {Vec3(5.0, 3.0, 0.0)});
    StepSettings settings = settingsOf(GetParam());
    settings.pushOut = false;
    Stepper stepper(settings);
    LastStep observer;
    stepper.observe(&observer);
    stepper.step(world, 1e-4);
    // In 0.1 ms nothing moves by more than g dt² = 1e-7 m.
    EXPECT_NEAR(observer.seen.overlap[0], 0.02, 1e-6);
    EXPECT_NEAR(observer.seen.overlap[1], 0.02, 1e-6);
    EXPECT_EQ(observer.seen.overlap[2], 0.0);
    EXPECT_EQ(observer.seen.level[2], 0);
}

INSTANTIATE_TEST_SUITE_P(StepObserver, BothMethods, testing::Values(Method::paper, Method::scree),
                         [](const auto& chosen) {
                             return chosen.param == Method::paper ? "Paper" : "Scree";
                         });

}  // namespace
}  // namespace scree::test
