// E1: a block at rest stays at rest although its collisions are elastic. [GBF03 figure 3],
// [A17, A39, A44]
#include <cmath>

#include "core/math/rotation.h"
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
        spin = larger(spin, spinOf(run.world, block).norm());
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
        furthest = larger(furthest, largestVertexShift(run.start, run.world, block));
        curve.x.push_back(k / 60.0);
        curve.y.push_back(
            (run.world.motion[block].position - run.start.motion[block].position).norm());
    }
    findings.atLeast(control, "textbook order of the step: largest shift within 2 s", furthest, 0.1,
                     "m", "velocity and position first, then collision: rest is taken for landing");
    plot.curves.push_back(curve);
}

double turnedBy(const ShotRun& run, BodyId body)
{
    const Quat turn =
        run.world.motion[body].orientation * run.start.motion[body].orientation.conjugate();
    return 2.0 * std::atan2(turn.vec().norm(), std::abs(turn.w())) * 180.0 / kPi;
}

/// Figure 3: the block bounces and tumbles down when gravity comes before collisions.
void tumbling(const Context& context, Findings& findings)
{
    constexpr double kRate = 60.0;
    Plot plot{"Figure 3: how far the block is turned, 60 Hz", "time [s]", "angle [degrees]", {}};
    ShotRun still(context, "E01_block_at_rest");
    const BodyId block = still.body("block");
    Curve rest{"the paper's order", {}, {}};
    still.advance(4.0, kRate, [&](const StepReport&, double t) {
        rest.x.push_back(t);
        rest.y.push_back(turnedBy(still, block));
    });
    addPicture(context, still, "Figure 3, right: the block after 4 s of the paper's order",
               findings);

    ShotRun run(context, "E01_block_at_rest");
    Curve curve{"control: gravity before collisions", {}, {}};
    double most = 0.0;
    for (int k = 1; k <= 4 * 60; ++k) {
        gravityFirstStep(run.world, run.shot.settings, 1.0 / kRate);
        curve.x.push_back(k / kRate);
        curve.y.push_back(turnedBy(run, block));
        most = larger(most, curve.y.back());
        if (k % 60 != 0 || k > 3 * 60) continue;
        addPicture(context, run,
                   "Figure 3, left, the control: after " + shortNumber(k / kRate) +
                       " s with gravity before collisions",
                   findings);
    }
    findings.atLeast(control, "gravity before collisions: the block is turned by, within 4 s", most,
                     90.0, "degrees", "it bounces on and tumbles down");
    plot.curves = {rest, curve};
    findings.plots.push_back(plot);
}

/// E1b: friction all but holds the block. a = 0.0624 m/s² is 1 % of gravity's share, so the 0.4 %
/// of friction that the method loses while its impulses are handed out one by one are much.
void belowTheFrictionAngle(const Context& context, Findings& findings)
{
    const SlideTheory theory{30.0, 0.57, 0.0};
    for (const auto& [rate, share] : {std::pair{240.0, 0.04}, std::pair{960.0, 0.01}}) {
        ShotRun run(context, "E01_block_at_rest",
                    {"material.slope.friction=0.57", "material.wood.friction=0.57"});
        const SlideErrors errors = slide(run, theory, rate);
        const double part = errors.position / errors.distance;
        const std::string name = "friction 0.57" + atRate(rate);
        if (context.method == "scree") {
            findings.atMost(must, name + ": error of the distance", part, 0.005, "of it");
        } else {
            findings.atMost(departure, name + ": error of the distance", part, 0.005, "of it",
                            "friction all but holds the block; the error is of first order in dt, "
                            "as the next row bounds");
            findings.atMost(must, name + ": error, first order in dt", part, share, "of it");
        }
        findings.atLeast(must, name + ": it slides", errors.distance, 0.12, "m");
    }
}

void onEveryFace(const Context& context, Findings& findings)
{
    double largest = 0.0;
    for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(90, 0, 0), Vec3(180, 0, 0), Vec3(270, 0, 0),
                             Vec3(0, 0, 90), Vec3(0, 0, -90)}) {
        ShotRun run(context, "E01_floor", {setVector("body.block.rotation", turn)});
        run.advance(1.0, 240.0);
        largest = larger(largest, largestVertexShift(run.start, run.world, run.body("block")));
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
    tumbling(context, findings);
    belowTheFrictionAngle(context, findings);
    onEveryFace(context, findings);
    findings.plots.push_back(plot);
}

}  // namespace scree::verify
