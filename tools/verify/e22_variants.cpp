// E22: variants of the method: lagged collisions, and the paper without the repairs documented
// beside it. [A25, A60]
#include <algorithm>
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/incline.h"
#include "tools/verify/shot_run.h"
#include "tools/verify/tilt.h"

namespace scree::verify {
namespace {

using enum Weight;

const std::string kStrict = "solver.strict=true";

struct HeapResult {
    double energyLost = 0.0, height = 0.0;  // [J], mean over the bodies [m]
};

HeapResult dropHeap(const Context& context, int layers, int seed, const std::string& collision)
{
    const int bodies = std::min(100, 9 * layers);
    ShotRun run(
        context, "E22_drop",
        {"shot.seed=" + std::to_string(seed), "emitter.drop.count=" + std::to_string(bodies),
         "emitter.drop.layout.grid.count=[3, " + std::to_string(layers) + ", 3]",
         setVector("emitter.drop.layout.position", {0.0, 0.4 + 0.55 * layers, 0.0}),
         "solver.collision=\"" + collision + "\""});
    run.advance(context.isFull() ? 5.0 : 2.5, 120.0);
    HeapResult result;
    const Vec3& gravity = run.shot.settings.gravity;
    result.energyLost = mechanicalEnergy(run.start, gravity) - mechanicalEnergy(run.world, gravity);
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        if (run.world.mass[b].isMovable()) result.height += run.world.motion[b].position.y();
    }
    result.height /= bodies;
    return result;
}

void laggedAgainstReevolve(const Context& context, Findings& findings)
{
    const int layers = context.isFull() ? 12 : 3, seeds = context.isFull() ? 10 : 2;
    double worstEnergy = 0.0, lagged = 0.0, reevolved = 0.0;
    int same = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const HeapResult a = dropHeap(context, layers, seed, "lagged");
        const HeapResult b = dropHeap(context, layers, seed, "reevolve");
        worstEnergy = larger(worstEnergy, std::abs(a.energyLost / b.energyLost - 1.0));
        same += a.energyLost == b.energyLost;
        lagged += a.height / seeds;
        reevolved += b.height / seeds;
    }
    const std::string name = "lagged, " + std::to_string(std::min(100, 9 * layers)) + " bodies, " +
                             std::to_string(seeds) + " seeds: ";
    findings.atMost(must, name + "energy lost, unlike reevolve's", worstEnergy, 0.2, "of it");
    findings.atMost(must, name + "height of the heap, unlike reevolve's",
                    std::abs(lagged / reevolved - 1.0), 0.1, "of it");
    findings.equal(control, name + "runs that are the same bits", same, 0,
                   "both would have run the same variant");
}

void strictAtRest(const Context& context, Findings& findings)
{
    ShotRun run(context, "E01_block_at_rest", {kStrict});
    const BodyId block = run.body("block");
    double shift = 0.0, spin = 0.0;
    run.advance(context.isFull() ? 10.0 : 2.0, 240.0, [&](const StepReport&, double) {
        shift = larger(shift, largestVertexShift(run.start, run.world, block));
        spin = larger(spin, spinOf(run.world, block).norm());
    });
    findings.atMost(must, "strict, E1: largest shift of a vertex", shift, 1e-6, "m",
                    "a gridded field");
    findings.atMost(must, "strict, E1: largest spin", spin, 1e-6, "rad/s");
}

void strictSliding(const Context& context, Findings& findings)
{
    for (const auto& [shot, theory] :
         {std::pair{"E02_accelerating", SlideTheory{30.0, 0.3, 0.0}},
          std::pair{"E02_decelerating", SlideTheory{15.0, 0.5, 4.0}}}) {
        for (const auto& [rate, share] : {std::pair{240.0, 0.005}, {1000.0, 0.001}}) {
            ShotRun run(context, shot, {kStrict});
            const std::string where = (shot + 4) + (", strict, " + shortNumber(rate) + " Hz");
            addSlideRows(where, slide(run, theory, rate), share, findings);
        }
    }
}

void strictBilliards(const Context& context, Findings& findings)
{
    ShotRun run(context, "E03_billiards", {kStrict, "shape.ball.collide=\"exact\""});
    run.advance(2.0, 240.0);
    findings.near(must, "strict, E3 frictionless: last ball", run.motion("ball_4").velocity.x(),
                  20.0, 1e-9, "m/s");
    double others = 0.0;
    for (const std::string ball : {"cue", "ball_0", "ball_1", "ball_2", "ball_3"})
        others = larger(others, run.motion(ball).velocity.norm());
    findings.atMost(departure, "strict, E3 frictionless: fastest of the others", others, 1e-9,
                    "m/s", "of balls that touch; a centimetre apart they stop");
}

void strictStack(const Context& context, Findings& findings)
{
    ShotRun run(context, "E04_stack_10", {kStrict});
    int levels = 0;
    run.advance(context.isFull() ? 5.0 : 2.0, 240.0,
                [&](const StepReport& report, double) { levels = report.levels; });
    double sink = 0.0, drift = 0.0, speed = 0.0;
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        speed = larger(speed, run.world.motion[b].velocity.norm());
        const Vec3 moved = run.world.motion[b].position - run.start.motion[b].position;
        sink = larger(sink, std::abs(moved.y()));
        drift = larger(drift, std::hypot(moved.x(), moved.z()));
    }
    findings.atMost(must, "strict, E4 stack of ten: sinks", sink, 2e-3, "m",
                    "fields have nodes on the cubes' faces");
    findings.atMost(must, "strict, E4 stack of ten: drift", drift, 5e-3, "m");
    findings.atMost(must, "strict, E4 stack of ten: speed at the end", speed, 5e-3, "m/s");
    findings.equal(must, "strict, E6: levels of the stack", levels, 11);
}

void strictSeeSaw(const Context& context, Findings& findings)
{
    ShotRun run(context, "E05_seesaw", {kStrict});
    const Curve tilt = tiltOver(run, context.isFull() ? 12.0 : 0.5);
    findings.near(must, "strict, E5: tilt at 0.25 s", tiltAt(tilt, 0.25), 1.887, 0.05 * 1.887,
                  "degrees");
    findings.near(must, "strict, E5: tilt at 0.5 s", tiltAt(tilt, 0.5), 7.547, 0.05 * 7.547,
                  "degrees");
    if (context.isFull()) {
        findings.near(must, "strict, E5: on the floor at 2 s", tiltAt(tilt, 2.0), 11.54, 0.2,
                      "degrees");
        findings.near(must, "strict, E5: light side down at 12 s", tiltAt(tilt, 12.0), -11.54, 0.2,
                      "degrees");
    }
}

void strictGraphs(const Context& context, Findings& findings)
{
    ShotRun ride(context, "E06_moving_floor", {kStrict});
    findings.equal(must, "strict, E6: stacks of 5 and 3 on a moving floor, a level for each cube",
                   levelsInAFrame(ride) == "12345123", 1);
    ShotRun run(context, "../dominoes", {kStrict});
    int levels = 0;
    run.advance(1.0 / 240.0, 240.0,
                [&](const StepReport& report, double) { levels = report.levels; });
    findings.equal(must, "strict, E6: levels of the ring of dominoes", levels, 2);
}

}  // namespace

void runVariants(const Context& context, Findings& findings)
{
    if (context.method != "paper") {
        findings.notRun(goal, "lagged and strict", "they are variants of method paper");
        return;
    }
    laggedAgainstReevolve(context, findings);
    strictAtRest(context, findings);
    strictSliding(context, findings);
    strictBilliards(context, findings);
    strictStack(context, findings);
    strictSeeSaw(context, findings);
    strictGraphs(context, findings);
}

}  // namespace scree::verify
