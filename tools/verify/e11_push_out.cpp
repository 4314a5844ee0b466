// E11: push-out separates what overlaps, moves only what may move, and touches no velocity.
// [A52, A53]
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

constexpr double kStep = 1.0 / 240.0;

void freeCubes(const Context& context, Findings& findings)
{
    ShotRun run(context, "E11_two_cubes");
    run.advance(10 * kStep, 240.0);
    const BodyMotion &lower = run.motion("lower"), &upper = run.motion("upper");
    findings.atMost(must, "two free cubes, ten steps: overlap",
                    PoseJudge(run.describe()).deepestOverlap(run.capture()), 1e-3, "m",
                    "dense samples");
    findings.near(must, "two free cubes: gap", upper.position.y() - lower.position.y() - 1.0, 0.0,
                  1e-3, "m");
    const Vec3 centre = 0.5 * (lower.position + upper.position);
    findings.atMost(must, "two free cubes: their common centre moves",
                    (centre - Vec3(0.0, 0.45, 0.0)).norm(), 1e-12, "m");
    bool isUntouched = true;
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        isUntouched &= run.world.motion[b].velocity == run.start.motion[b].velocity &&
                       run.world.motion[b].angularMomentum == run.start.motion[b].angularMomentum;
    }
    findings.equal(must, "two free cubes: velocities and momenta are the same bits", isUntouched,
                   1);
}

void onTheFloor(const Context& context, Findings& findings)
{
    ShotRun run(context, "E11_floor");
    run.advance(10 * kStep, 240.0);
    findings.near(must, "cube 10 cm in the floor, ten steps: its height",
                  run.motion("cube").position.y(), 0.5, 1e-3, "m");
    findings.atMost(must, "the floor moves", run.motion("floor").position.norm(), 0.0, "m");
    findings.atMost(must, "the cube gains speed", run.motion("cube").velocity.norm(), 1e-9, "m/s");
}

void column(const Context& context, Findings& findings)
{
    ShotRun run(context, "E11_column");
    const PoseJudge judge(run.describe());
    std::vector<double> overlaps;
    double heightError = 0.0, sunk = 0.0;
    std::vector<double> before;
    for (int i = 0; i < 5; ++i)
        before.push_back(run.motion("cube_000" + std::to_string(i)).position.y());
    run.advance(10 * kStep, 240.0, [&](const StepReport&, double) {
        overlaps.push_back(judge.deepestOverlap(run.capture()));
        for (int i = 0; i < 5; ++i) {
            const double height = run.motion("cube_000" + std::to_string(i)).position.y();
            if (overlaps.size() == 1) heightError = larger(heightError, std::abs(height - i - 0.5));
            sunk = larger(sunk, before[i] - height);
            before[i] = height;
        }
    });
    findings.atMost(must, "column of five, each 2 cm in the next, one step: overlap",
                    overlaps.front(), 0.01, "m");
    findings.atMost(must, "column, one step: heights off", heightError, 0.01, "m",
                    "it comes apart from below: no cube was pushed down");
    findings.atMost(must, "column: goes down in a step, any cube", sunk, 1e-3, "m",
                    "what is above moves, not what is below");
    findings.atMost(must, "column, ten steps: overlap", overlaps.back(), 1e-3, "m");

    ShotRun with(context, "E11_column"), without(context, "E11_column", {"solver.push_out=false"});
    with.advance(kStep, 240.0);
    StepReport report;
    without.advance(kStep, 240.0, [&](const StepReport& step, double) { report = step; });
    double difference = 0.0, offWay = 0.0;
    for (std::size_t b = 0; b < with.world.bodyCount(); ++b) {
        const BodyMotion &was = without.start.motion[b], &is = without.world.motion[b];
        difference = larger(difference, (with.world.motion[b].velocity - is.velocity).norm());
        offWay = larger(offWay, (was.position + kStep * is.velocity - is.position).norm());
    }
    findings.atMost(must, "switched off: positions off the step's velocity", offWay, 1e-15, "m",
                    "rounding");
    findings.equal(must, "switched off: pushes", static_cast<double>(report.pushes), 0);
    findings.atMost(must, "switched off: velocities differ from the run with it", difference, 0.0,
                    "m/s");

    ShotRun still(context, "E11_column", {"solver.push_out=false", "shot.gravity=[0, 0, 0]"});
    still.advance(10 * kStep, 240.0);
    double moved = 0.0;
    for (std::size_t b = 0; b < still.world.bodyCount(); ++b) {
        moved =
            larger(moved, (still.world.motion[b].position - still.start.motion[b].position).norm());
    }
    findings.atMost(must, "switched off, without weight: anything moves", moved, 0.0, "m");
}

void betweenWalls(const Context& context, Findings& findings)
{
    ShotRun run(context, "E11_walls");
    Vec3 before = run.motion("cube").position;
    double shift = 0.0, away = 0.0;
    std::int64_t pushes = 0;
    run.advance(20 * kStep, 240.0, [&](const StepReport& report, double) {
        const Vec3 now = run.motion("cube").position;
        shift = larger(shift, (now - before).norm());
        away = larger(away, std::abs(now.x()));
        before = now;
        pushes += report.pushes;
    });
    findings.atMost(must, "between walls too close: shift in a step", shift, 0.5, "m");
    findings.atMost(must, "between walls too close: off the middle", away, 0.2, "m");
    findings.atLeast(must, "between walls too close: pushes reported", static_cast<double>(pushes),
                     1.0, "");
    findings.atMost(must, "between walls too close: speed gained",
                    run.motion("cube").velocity.norm(), 1e-12, "m/s");
}

/// How unequally two cubes, equally deep in a third, stand after one step.
double asymmetry(const Context& context, int levelIterations)
{
    ShotRun run(context, "E11_two_on_one",
                {"solver.push_out_level_iterations=" + std::to_string(levelIterations)});
    run.advance(kStep, 240.0);
    return std::abs(run.motion("left").position.y() - run.motion("right").position.y());
}

void gradually(const Context& context, Findings& findings)
{
    const double gradual = asymmetry(context, 4), atOnce = asymmetry(context, 1);
    findings.report("two cubes on one, gradual: they stand apart in height", gradual, "m");
    findings.report("two cubes on one, at once: they stand apart in height", atOnce, "m");
    findings.atMost(must, "two cubes on one: gradual over at once", gradual / atOnce, 0.99, "-",
                    "whoever is pushed first moves the third away from the other");
}

}  // namespace

void runPushOut(const Context& context, Findings& findings)
{
    freeCubes(context, findings);
    onTheFloor(context, findings);
    column(context, findings);
    betweenWalls(context, findings);
    gradually(context, findings);
}

}  // namespace scree::verify
