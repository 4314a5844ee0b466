// What the phases of a step promise each other: one prediction, one graph, a full report.
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "core/base/random.h"
#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

constexpr double kDt = 1.0 / 96.0;

Vec3 draw(std::uint64_t body, std::uint64_t what, double size)
{
    Vec3 v;
    for (std::uint64_t k = 0; k < 3; ++k) v[k] = size * (2.0 * randomUnit(58, body, what, k) - 1.0);
    return v;
}

/// Three columns of three cubes on a plane; those of the third column fall onto each other.
World makeColumns()
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < 9; ++i) {
        const int column = i / 3, place = i % 3;
        const double gap = column == 2 ? 0.05 : 0.0;
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{3.0 * column, 0.5 + (1.0 + gap) * place + gap, 0.0}, Quat::Identity()}, 1.0 + i,
                {0.0, column == 2 ? -2.0 : 0.0, 0.0});
    }
    return world;
}

TEST(Prediction, IsWhereTheStepThenTakesTheBodyToTheLastBit)  // [A20]
{
    for (const OrientationUpdate update : {OrientationUpdate::euler, OrientationUpdate::secondOrder,
                                           OrientationUpdate::symplectic}) {
        StepSettings settings = experimentSettings();
        settings.orientation = update;
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.3);
        for (std::uint64_t b = 0; b < 50; ++b) {
            addBody(world, boxShape({0.2, 0.4, 0.8}, 1), material,
                    {{100.0 * static_cast<double>(b), 0.0, 0.0}, exponentialMap(draw(b, 0, 3.0))},
                    1.0, draw(b, 1, 9.0), draw(b, 2, 9.0));
        }
        // Predicted as collision, graph and contact do it: with gravity, which comes later.
        StepScratch scratch;
        findPairs(world, settings, kDt, scratch);
        beginStep(world, settings, kDt, scratch);
        const std::vector<Pose> fall = scratch.fallPose;
        std::vector<Pose> drift = scratch.driftPose;
        addForces(world, scratch.forces, kDt);
        World after = world;
        advancePositions(after, settings, kDt);
        for (std::size_t b = 0; b < world.bodyCount(); ++b) {
            EXPECT_EQ(fall[b].position, after.motion[b].position);
            EXPECT_EQ(fall[b].orientation.coeffs(), after.motion[b].orientation.coeffs());
            EXPECT_NE(drift[b].position, after.motion[b].position);
        }
    }
}

TEST(ContactGraph, BuiltOnceServesContactAndShockWhichTouchNoOtherPair)  // [A48]
{
    World world = makeColumns();
    const StepSettings settings = experimentSettings();
    StepScratch scratch;
    int impulses = 0;
    for (int k = 0; k < 10; ++k) {
        findPairs(world, settings, kDt, scratch);
        beginStep(world, settings, kDt, scratch);
        resolveCollisions(world, settings, kDt, scratch);
        const ContactGraph graph = buildContactGraph(world, settings, kDt, scratch);
        std::set<std::size_t> inGraph;
        for (const ContactLevel& level : graph.contact) {
            for (const std::size_t pair : level.pairs) {
                // Each unordered pair once.  [A38]
                EXPECT_TRUE(inGraph.insert(pair).second);
            }
        }
        EXPECT_EQ(static_cast<std::int64_t>(inGraph.size()), graph.contactPairs);
        for (std::size_t i = 0; i < scratch.pairCount; ++i) scratch.pairs[i].isWatched = true;
        addForces(world, scratch.forces, kDt);
        resolveContacts(world, graph, settings, kDt, scratch);
        propagateShock(world, graph, settings, kDt, scratch);
        for (std::size_t i = 0; i < scratch.pairCount; ++i) {
            if (scratch.pairs[i].impulses.empty()) continue;
            ++impulses;
            EXPECT_TRUE(inGraph.count(i)) << "step " << k << ", pair " << i;
        }
        advancePositions(world, settings, kDt);
    }
    EXPECT_GT(impulses, 50);
}

TEST(StepReport, TellsTheWorstShareThoughAnotherPairIsDeeper)  // [A58]
{
    for (const bool isPaper : {true, false}) {
        World world;
        const MaterialId material = addMaterial(world, 0.5, 0.0);
        addPlane(world, material);
        addBody(world, boxShape(Vec3::Constant(4.0), 2), material,
                {{0.0, 1.97, 0.0}, Quat::Identity()});
        const BodyId pebble = addBody(world, boxShape(Vec3::Constant(0.05), 2), material,
                                      {{10.0, 0.005, 0.0}, Quat::Identity()});
        StepSettings settings = isPaper ? experimentSettings() : screeSettings();
        settings.pushOut = false;
        settings.gravity.setZero();
        const StepReport report = Stepper(settings).step(world, kDt);
        EXPECT_NEAR(report.deepestAfterPushOut, 0.03, 1e-9) << isPaper;
        EXPECT_NEAR(report.worstOverlapRatio, 0.4, 1e-6) << isPaper;
        EXPECT_EQ(report.worstB, pebble) << isPaper;
    }
}

TEST(StepReport, OfGapsCountsPairsThatBearPlacesAndLevels)  // [A58]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.0);
    addPlane(world, material);
    for (int i = 0; i < 6; ++i) {
        addBody(world, boxShape(Vec3::Ones(), 1), material,
                {{4.0 * (i % 2), 0.5 + i / 2, 0.0}, Quat::Identity()});
    }
    StepSettings settings = screeSettings();
    settings.sleep = false;
    // A ball that passes a millimetre above the floor: a pair that touches and does not bear.
    addBody(world, exactSphere(0.2), material, {{9.0, 0.201, 0.0}, Quat::Identity()}, 1.0,
            {0.0, 1.0, 0.0});
    Stepper stepper(settings);
    const StepReport report = stepper.step(world, kDt);
    EXPECT_EQ(report.touchingPairs, 7);
    EXPECT_EQ(report.contactPairs, 6);
    EXPECT_EQ(report.contacts, 6 * 4 + 1);
    EXPECT_EQ(report.levels, 4);
    EXPECT_EQ(report.largestLevel, 2);
}

TEST(StepReport, AccountsForWhatTheStepDid)  // [A58]
{
    World world = makeColumns();
    const StepSettings settings = experimentSettings();
    Stepper stepper(settings);
    StepReport sum;
    for (int k = 0; k < 12; ++k) {
        const StepReport report = stepper.step(world, kDt);
        EXPECT_EQ(report.dt, kDt);
        EXPECT_GE(report.broadPairs, report.touchingPairs);
        EXPECT_GE(report.touchingPairs, report.contactPairs);
        EXPECT_GE(report.contactPairs, 6);  // of the columns at rest
        EXPECT_GE(report.levels, 4);
        EXPECT_GE(report.largestLevel, 2);
        EXPECT_GE(report.deepestBeforePushOut, report.deepestAfterPushOut);
        EXPECT_GT(std::accumulate(report.seconds.begin(), report.seconds.end(), 0.0), 0.0);
        EXPECT_TRUE(report.nonFinite.empty());
        sum.collisionImpulses += report.collisionImpulses;
        sum.contactImpulses += report.contactImpulses;
        sum.shockImpulses += report.shockImpulses;
    }
    EXPECT_GT(sum.collisionImpulses.total(), 0);  // the third column lands
    EXPECT_GT(sum.contactImpulses.total(), 0);
    EXPECT_GT(sum.shockImpulses.total(), 0);

    const FrameReport frame = stepper.advanceFrame(world, 1.0 / 24.0);
    EXPECT_GT(frame.steps, 1);
    EXPECT_LT(frame.longestStep, 1.0 / 24.0);  // a cube of a metre would hover at one step a frame
    double kinetic = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (std::size_t b = 1; b < world.bodyCount(); ++b) {
        kinetic += kineticEnergy(world.motion[b], world.mass[b]);
        momentum += world.motion[b].velocity / world.mass[b].inverseMass;
    }
    EXPECT_NEAR(frame.kineticEnergy + frame.potentialEnergy,
                mechanicalEnergy(world, settings.gravity), 1e-9);
    EXPECT_NEAR(frame.kineticEnergy, kinetic, 1e-12);
    EXPECT_LE((frame.momentum - momentum).norm(), 1e-12);
}

TEST(StepReport, NamesTheBodyAndThePhaseWhereNumbersEnd)  // [A59]
{
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < 2; ++i) {
        addBody(world, boxShape(Vec3::Ones(), 2), material,
                {{3.0 * i, 2.0, 0.0}, Quat::Identity()});
    }
    world.info[2].force.x() = std::nan("");
    const FrameReport report = Stepper(experimentSettings()).advanceFrame(world, 1.0 / 24.0);
    ASSERT_EQ(report.sum.nonFinite, std::vector<BodyId>{2});
    EXPECT_EQ(report.sum.nonFinitePhase, Phase::contact);
    EXPECT_TRUE(world.motion[2].position.allFinite()) << "no later phase went on with it";
    EXPECT_EQ(world.clock.frame, 0);
}

}  // namespace
}  // namespace scree::test
