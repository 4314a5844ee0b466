// E1: a block at rest stays at rest although its collisions are elastic. [GBF03 figure 3],
// [A17, A39, A44]
#include <algorithm>

#include "tools/verify/controls.h"
#include "tools/verify/experiments.h"
#include "tools/verify/incline.h"

namespace scree::verify {
namespace {

using enum Weight;

std::string atRate(double stepsPerSecond)
{
    return " at " + shortNumber(stepsPerSecond) + " Hz";
}

/// How far the block of a run was from its start in each step.
Curve shiftOver(ShotRun& run, double seconds, double rate, double& spin)
{
    Curve curve;
    const BodyId block = run.body("block");
    run.advance(seconds, rate, [&](const StepReport&, double t) {
        spin = std::max(spin, spinOf(run.world, block).norm());
        curve.x.push_back(t);
        curve.y.push_back(
            (run.world.motion[block].position - run.start.motion[block].position).norm());
    });
    return curve;
}

void onThePlane(const Context& context, Findings& findings, Plot& plot)
{
    for (int segments : {1, 2}) {
        const std::string corners = segments == 1 ? "8 vertices" : "26 vertices";
        const std::string cut = "shape.block.box.segments=[" + std::to_string(segments) + ", " +
                                std::to_string(segments) + ", " + std::to_string(segments) + "]";
        for (double rate : {24.0, 60.0, 240.0, 960.0}) {
            const double seconds = context.isFull() || rate < 240.0 ? 10.0 : 2.0;
            ShotRun run(context, "E01_block_at_rest", {cut});
            double spin = 0.0;
            Curve curve = shiftOver(run, seconds, rate, spin);
            const BodyId block = run.body("block");
            findings.atMost(must, corners + atRate(rate) + ": largest shift of a vertex",
                            largestVertexShift(run.start, run.world, block), 1e-9, "m");
            findings.atMost(must, corners + atRate(rate) + ": largest spin", spin, 1e-9, "rad/s");
            if (segments == 2 && rate == 60.0) {
                curve.name = "the paper's order";
                plot.curves.push_back(curve);
                addPicture(context, run, "The block after " + shortNumber(seconds) + " s",
                           findings);
            }
        }
    }
}

void onTheSlab(const Context& context, Findings& findings)
{
    ShotRun run(context, "E01_slab");
    run.advance(10.0, 60.0);
    findings.atMost(must, "on a slab with a gridded field at 60 Hz: largest shift of a vertex",
                    largestVertexShift(run.start, run.world, run.body("block")), 1e-6, "m");
}

void exactAndDefaults(const Context& context, Findings& findings)
{
    for (double rate : {24.0, 240.0}) {
        ShotRun exact(context, "E01_block_at_rest", asExactSolids({"block"}));
        exact.advance(context.isFull() ? 10.0 : 2.0, rate);
        findings.atMost(must, "exact box" + atRate(rate) + ": largest shift of a vertex",
                        largestVertexShift(exact.start, exact.world, exact.body("block")), 1e-9,
                        "m");
    }
    ShotRun usual(context, "E01_block_at_rest", withDefaultSteps());
    usual.advanceFrames(context.isFull() ? 240 : 48);
    findings.atMost(must, "steps as by default: largest shift of a vertex",
                    largestVertexShift(usual.start, usual.world, usual.body("block")), 1e-9, "m");
}

void textbookOrder(const Context& context, Findings& findings, Plot& plot)
{
    ShotRun run(context, "E01_block_at_rest");
    const BodyId block = run.body("block");
    Curve curve;
    curve.name = "control: the textbook order";
    double furthest = 0.0;
    for (int k = 1; k <= 2 * 60; ++k) {
        textbookStep(run.world, run.shot.settings, 1.0 / 60.0);
        furthest = std::max(furthest, largestVertexShift(run.start, run.world, block));
        curve.x.push_back(k / 60.0);
        curve.y.push_back(
            (run.world.motion[block].position - run.start.motion[block].position).norm());
    }
    findings.atLeast(control, "textbook order of the step: largest shift within 2 s", furthest, 0.1,
                     "m", "velocity and position first, then collision: rest is taken for landing");
    plot.curves.push_back(curve);
    addPicture(context, run, "Control: the same block after 2 s in the textbook order", findings);
}

/// E1b: friction all but holds the block. a = 0.0624 m/s² is 1 % of gravity's share, so the 0.4 %
/// of friction that the method loses while its impulses are handed out one by one are much.
void belowTheFrictionAngle(const Context& context, Findings& findings)
{
    const SlideTheory theory{30.0, 0.57, 0.0};
    for (const auto& [rate, share] : {std::pair{240.0, 0.04}, std::pair{960.0, 0.01}}) {
        ShotRun run(context, "E01_block_at_rest",
                    {"material.slope.friction=0.57", "material.wood.friction=0.57",
                     "material.slope.restitution=0", "material.wood.restitution=0"});
        const SlideErrors errors = slide(run, theory, rate);
        const double part = errors.position / errors.distance;
        if (rate == 240.0) {
            findings.atMost(departure, "friction 0.57" + atRate(rate) + ": error of the distance",
                            part, 0.005, "of it",
                            "friction all but holds the block; the error is of first order in dt, "
                            "as the next rows bound");
        }
        findings.atMost(must, "friction 0.57" + atRate(rate) + ": error, first order in dt", part,
                        share, "of it");
        findings.atLeast(must, "friction 0.57" + atRate(rate) + ": it slides", errors.distance,
                         0.12, "m");
    }
}

void onEveryFace(const Context& context, Findings& findings)
{
    double largest = 0.0;
    for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(90, 0, 0), Vec3(180, 0, 0), Vec3(270, 0, 0),
                             Vec3(0, 0, 90), Vec3(0, 0, -90)}) {
        ShotRun run(context, "E01_floor", {setVector("body.block.rotation", turn)});
        run.advance(1.0, 240.0);
        largest = std::max(largest, largestVertexShift(run.start, run.world, run.body("block")));
    }
    findings.atMost(must, "on a level floor, on any of six faces: largest shift in 1 s", largest,
                    1e-9, "m");
}

}  // namespace

void runBlockAtRest(const Context& context, Findings& findings)
{
    Plot plot{"Distance of the block from where it was put, 60 Hz", "time [s]", "distance [m]", {}};
    onThePlane(context, findings, plot);
    onTheSlab(context, findings);
    exactAndDefaults(context, findings);
    textbookOrder(context, findings, plot);
    belowTheFrictionAngle(context, findings);
    onEveryFace(context, findings);
    findings.plots.push_back(plot);
}

}  // namespace scree::verify
