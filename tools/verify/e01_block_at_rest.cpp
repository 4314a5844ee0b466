// E1: a block at rest stays at rest although its collisions are elastic. [GBF03 figure 3],
// [A17, A39, A44]
#include <cmath>
#include <tuple>

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

/// How the block of a run stirred in any step: a block that comes back has moved too.
struct Stir {
    double shift = 0.0, spin = 0.0;  // of a vertex [m], of the block [rad/s]

    void look(const World& start, const World& now, BodyId block)
    {
        shift = larger(shift, largestVertexShift(start, now, block));
        spin = larger(spin, spinOf(now, block).norm());
    }
};

/// `way`: the distance of its centre from the start, over time.
Stir stirOver(ShotRun& run, double seconds, double rate, Curve* way = nullptr)
{
    Stir stir;
    const BodyId block = run.body("block");
    run.advance(seconds, rate, [&](const StepReport&, double t) {
        stir.look(run.start, run.world, block);
        if (!way) return;
        way->x.push_back(t);
        way->y.push_back(
            (run.world.motion[block].position - run.start.motion[block].position).norm());
    });
    return stir;
}

void addRows(const std::string& name, const Stir& stir, double allowed, Findings& findings)
{
    findings.atMost(must, name + ": largest shift of a vertex", stir.shift, allowed, "m");
    findings.atMost(must, name + ": largest spin", stir.spin, allowed, "rad/s");
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
            Curve way{"the paper's order", {}, {}};
            addRows(corners + atRate(rate), stirOver(run, seconds, rate, &way), 1e-9, findings);
            if (segments == 2 && rate == 60.0) plot.curves.push_back(way);
        }
    }
}

/// On a mesh with a gridded field.
void onTheSlab(const Context& context, Findings& findings)
{
    const std::vector<double> rates =
        context.isFull() ? std::vector{24.0, 60.0, 240.0, 960.0} : std::vector{60.0};
    for (double rate : rates) {
        ShotRun run(context, "E01_slab");
        addRows("on a slab" + atRate(rate), stirOver(run, 10.0, rate), 1e-6, findings);
    }
}

void exactAndDefaults(const Context& context, Findings& findings)
{
    for (double rate : {24.0, 240.0}) {
        ShotRun exact(context, "E01_block_at_rest", asExactSolids({"block"}));
        addRows("exact box" + atRate(rate), stirOver(exact, context.isFull() ? 10.0 : 2.0, rate),
                1e-9, findings);
    }
    ShotRun usual(context, "E01_block_at_rest", withDefaultSteps());
    Stir stir;
    usual.advanceFrames(context.isFull() ? 240 : 48, {}, [&](const World& now, double) {
        stir.look(usual.start, now, usual.body("block"));
    });
    addRows("steps as by default", stir, 1e-9, findings);
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
    const Weight weight = context.method == "scree" ? must : departure;
    const std::string why = context.method == "scree"
                                ? ""
                                : "friction all but holds the block; the error is of first order "
                                  "in dt, as another row bounds";
    for (const auto& [rate, share, ofPaper] :
         {std::tuple{240.0, 0.005, 0.04}, std::tuple{1000.0, 0.001, 0.01}}) {
        ShotRun run(context, "E01_block_at_rest",
                    {"material.slope.friction=0.57", "material.wood.friction=0.57"});
        const SlideErrors errors = slide(run, theory, rate);
        const double part = errors.position / errors.distance;
        const std::string name = "friction 0.57" + atRate(rate);
        findings.atMost(weight, name + ": error of the distance", part, share, "of it", why);
        findings.atMost(weight, name + ": error of the speed", errors.slidingSpeed, 1e-4, "m/s",
                        why);
        if (context.method == "paper") {
            findings.atMost(must, name + ": error, first order in dt", part, ofPaper, "of it");
        }
        findings.atMost(must, name + ": rotation", errors.rotation, 1e-3, "rad");
        findings.atMost(must, name + ": drift off the line", errors.drift, 1e-4, "m");
        findings.atLeast(must, name + ": it slides", errors.measured.y.back(), 0.12, "m");
    }
}

/// E1c, turned about the vertical too.
void onEveryFace(const Context& context, Findings& findings)
{
    Stir most;
    for (double heading : {0.0, 0.4, 1.1}) {
        for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(90, 0, 0), Vec3(180, 0, 0), Vec3(270, 0, 0),
                                 Vec3(0, 0, 90), Vec3(0, 0, -90)}) {
            ShotRun run(context, "E01_floor", {setVector("body.block.rotation", turn)});
            Quat& orientation = run.world.motion[run.body("block")].orientation;
            orientation = exponentialMap({0.0, heading, 0.0}) * orientation;
            run.start = run.world;
            const Stir stir = stirOver(run, 1.0, 240.0);
            most = {larger(most.shift, stir.shift), larger(most.spin, stir.spin)};
        }
    }
    addRows("on a level floor, on any of six faces, three headings, 1 s", most, 1e-9, findings);
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
