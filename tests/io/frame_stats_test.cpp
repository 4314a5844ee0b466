#include "io/frame_stats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/dynamics/step_figures.h"

namespace scree {
namespace {

// Who reads stats.jsonl trusts the names alone.
TEST(FrameStats, EveryFigureStandsUnderItsOwnName)
{
    World world;
    world.info.resize(2);
    world.info[0].name = "ground";
    world.info[1].name = "block";
    FrameStats stats;
    stats.frame = 1001;
    stats.wallSeconds = 0.5;
    stats.cpuSeconds = 0.75;
    stats.resumedAtSubStep = 3;
    FrameReport& report = stats.report;
    report.steps = 4;
    report.shortestStep = 0.01;
    report.longestStep = 0.02;
    report.fastestBody = 1;
    report.kineticEnergy = 21.0;
    report.potentialEnergy = 22.0;
    report.momentum = {1.0, 2.0, 3.0};
    report.angularMomentum = {4.0, 5.0, 6.0};
    report.bodiesAwake = 23;
    report.births.born = 24;
    report.births.waiting = 25;
    report.births.skipped = 26;
    StepReport& sum = report.sum;
    sum.limitedBy = StepLimit::hover;
    sum.broadPairs = 31;
    sum.touchingPairs = 32;
    sum.contactPairs = 33;
    sum.contacts = 34;
    sum.levels = 35;
    sum.largestLevel = 36;
    sum.collisionImpulses.sticking = 37;
    sum.contactImpulses.sliding = 38;
    sum.shockImpulses.fallback = 39;
    sum.pushes = 40;
    sum.pushesCut = 41;
    sum.loopsAtTheirCap = 42;
    sum.deepestBeforePushOut = 43.0;
    sum.deepestAfterPushOut = 44.0;
    sum.worstOverlapRatio = 45.0;
    sum.worstA = 0;
    sum.worstB = 1;
    sum.pushOutWork = 46.0;
    sum.seconds[static_cast<int>(Phase::shock)] = 0.047;

    const nlohmann::json expected = nlohmann::json::parse(R"({
        "frame": 1001, "wall_s": 0.5, "cpu_s": 0.75, "resumed_at_substep": 3,
        "substeps": 4, "step_s": [0.01, 0.02], "fastest_body": "block", "limited_by": "hover",
        "kinetic_energy_J": 21.0, "potential_energy_J": 22.0,
        "momentum": [1.0, 2.0, 3.0], "angular_momentum": [4.0, 5.0, 6.0],
        "bodies_awake": 23, "births": {"born": 24, "waiting": 25, "skipped": 26},
        "broad_pairs": 31, "touching_pairs": 32, "contact_pairs": 33, "contacts": 34,
        "levels": 35, "largest_level": 36, "pushes": 40, "pushes_cut": 41, "loops_at_cap": 42,
        "overlap": {"before_push_out_m": 43.0, "after_push_out_m": 44.0, "worst_ratio": 45.0,
                    "bodies": ["ground", "block"]},
        "push_out_work_J": 46.0
    })");
    const nlohmann::json line = nlohmann::json::parse(encodeStats(stats, world));
    for (const auto& [name, value] : expected.items()) EXPECT_EQ(line.at(name), value) << name;
    EXPECT_EQ(line.at("impulses").at("collision").at("sticking"), 37);
    EXPECT_EQ(line.at("impulses").at("contact").at("sliding"), 38);
    EXPECT_EQ(line.at("impulses").at("shock").at("fallback"), 39);
    EXPECT_NEAR(line.at("phase_ms").at("shock").get<double>(), 47.0, 1e-9);
    EXPECT_EQ(line.at("phase_ms").at("contact"), 0.0);
}

TEST(FrameStats, AFrameInTwoSittingsHasTheFiguresOfOne)
{
    FrameReport whole, before, after;
    for (int i = 0; i < 6; ++i) {
        StepReport step;
        step.dt = i == 1 ? 0.25 : 0.5;
        step.limitedBy = i == 1 ? StepLimit::spin : StepLimit::relativeSpeed;
        step.contactPairs = i == 2 ? 9 : i;
        step.contactImpulses.sticking = 10 + i;
        step.pushes = i;
        step.deepestAfterPushOut = i == 0 ? 0.75 : 0.5;
        step.worstOverlapRatio = i == 0 || i == 4 ? 0.125 : 0.0625;
        step.worstA = i;
        step.worstB = i + 1;
        for (FrameReport* frame : {&whole, i < 3 ? &before : &after}) {
            if (frame->steps == 0 || step.dt < frame->shortestStep) frame->fastestBody = i;
            frame->substepCapReached = frame->substepCapReached || i == 1;
            addStep(step, *frame);
        }
    }
    addEarlier(before, after);
    World world;
    world.info.resize(8);
    for (int i = 0; i < 8; ++i) world.info[i].name = "b" + std::to_string(i);
    FrameStats one, two;
    one.report = whole;
    two.report = after;
    EXPECT_EQ(encodeStats(two, world), encodeStats(one, world));

    // Of no earlier sitting nothing is taken, not even zeros.
    addEarlier(FrameReport(), two.report);
    EXPECT_EQ(encodeStats(two, world), encodeStats(one, world));
}

}  // namespace
}  // namespace scree
