// E12: what is fast and thin does not pass through, because time steps are limited.  [A16]
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "tools/verify/experiments.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

const std::string kUnlimited = "solver.substeps.max=1";

/// Shoots the run's ball at its plate from a random side and place, for a frame; whether it is
/// through.
bool passesPlate(ShotRun& run, std::uint64_t shot, int& mostSteps)
{
    const auto draw = [&](std::uint64_t what) { return 2.0 * randomUnit(12, shot, what) - 1.0; };
    const Vec3 direction = Vec3(draw(0), -0.5 - 0.5 * std::abs(draw(2)), draw(1)).normalized();
    const Vec3 target(0.4 * draw(3), 0.005, 0.4 * draw(4));
    const double distance = 0.05 + 0.02 * draw(5);
    run.world = run.start;
    BodyMotion& ball = run.world.motion[run.body("ball")];
    ball.position = target - distance * direction;
    ball.velocity = 100.0 * direction;
    Stepper stepper(run.shot.settings);
    const FrameReport report = stepper.advanceFrame(run.world, 1.0 / run.shot.framesPerSecond);
    mostSteps = std::max(mostSteps, report.steps);
    // Where the ball is once it is clear of the plate: one that bounced falls by less than a
    // centimetre within the frame.
    return !(run.motion("ball").position.y() >= 0.0);
}

void plate(const Context& context, Findings& findings)
{
    ShotRun limited(context, "E12_plate"), unlimited(context, "E12_plate", {kUnlimited});
    // What has left the plate needs no short steps: full frames cost the flight up to it.
    const std::uint64_t shots = context.isFull() ? 1000 : 100;
    int through = 0, missed = 0, steps = 0, ignored = 0;
    for (std::uint64_t shot = 0; shot < shots; ++shot) {
        through += passesPlate(limited, shot, steps);
        missed += passesPlate(unlimited, shot, ignored);
    }
    const std::string count = std::to_string(shots) + " balls of 1 cm at 100 m/s, plate of 1 cm: ";
    findings.equal(must, count + "tunnel", through, 0);
    findings.report(count + "most steps in a frame", steps, "",
                    "dt <= 25 us asks for 1667; the cap is 2000");
    findings.atLeast(context.controlOfPaper(), count + "tunnel, one step a frame",
                     static_cast<double>(missed) / static_cast<double>(shots), 0.9, "of them");
}

/// Whether the run's spinning rod passes its post within a fifth of a second.
bool passesPost(ShotRun& run)
{
    const Vec3 post = run.motion("post").position;
    const BodyId rod = run.body("rod");
    bool passes = false;
    double sideBefore = 0.0;
    run.advanceFrames(5, {}, [&](const World& now, double) {
        const Vec3 local = inverse(now.worldFromAsset(rod)) * post;
        const bool isBeside = std::abs(local.x()) < 0.95;
        passes = passes || (isBeside && sideBefore * local.z() < 0.0);
        sideBefore = isBeside ? local.z() : 0.0;
    });
    return passes;
}

void rod(const Context& context, Findings& findings)
{
    ShotRun limited(context, "E12_rod"), unlimited(context, "E12_rod", {"solver.substeps.max=12"});
    findings.equal(must, "rod of 2 m x 2 cm at 100 rad/s: passes the post", passesPost(limited), 0);
    findings.equal(context.controlOfPaper(), "the same with 12 steps a frame: passes",
                   passesPost(unlimited), 1);
}

struct Sweep {
    int inside = 0;        ///< boxes that are left inside the blade
    double overlap = 0.0;  ///< deepest of any frame [m]
};

Sweep sweep(ShotRun& run)
{
    const PoseJudge judge(run.describe());
    const BodyId blade = run.body("blade");
    Sweep result;
    run.advanceFrames(18, [&](const FrameReport&) {
        result.overlap = larger(result.overlap, judge.deepestOverlap(run.capture()));
    });
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        if (!run.world.mass[b].isMovable()) continue;
        const Vec3 x = inverse(run.world.worldFromAsset(blade)) * run.world.motion[b].position;
        // Half the blade and half a box: the centre of a box that is free of it lies outside.
        result.inside += std::abs(x.x()) < 1.0 && std::abs(x.y()) < 0.2 && std::abs(x.z()) < 0.1;
    }
    return result;
}

void blade(const Context& context, Findings& findings)
{
    ShotRun run(context, "E12_blade"), unlimited(context, "E12_blade", {kUnlimited});
    const Sweep limited = sweep(run);
    addPicture(context, run, "A keyed blade has swept through a heap of boxes", findings);
    findings.equal(must, "blade at 15 m/s through a heap: boxes left inside", limited.inside, 0);
    findings.atMost(must, "blade through a heap: overlap in any frame", limited.overlap, 0.02, "m",
                    "a tenth of a box, by dense samples");
    findings.atLeast(context.controlOfPaper(), "the same, one step a frame: overlap",
                     sweep(unlimited).overlap, 0.02, "m");
}

void atRest(const Context& context, Findings& findings)
{
    ShotRun run(context, "E12_plate", {"shot.gravity=[0, 0, 0]", "body.ball.velocity=[0, 0, 0]"});
    int steps = 0;
    run.advanceFrames(1, [&](const FrameReport& report) { steps = report.steps; });
    findings.equal(must, "nothing moves: steps in a frame", steps, 1);
    ShotRun resting(context, "E01_floor", withDefaultSteps());
    resting.advanceFrames(1, [&](const FrameReport& report) { steps = report.steps; });
    findings.equal(departure, "a cube has been put on a floor: steps in a frame", steps, 1,
                   context.method == "scree"
                       ? "what is awake falls no more than 2 % of its thickness in a step"
                       : "so short that the step's fall, by which it hovers, is not seen (A16)");
    if (context.method == "paper") return;
    resting.advanceFrames(48, [&](const FrameReport& report) { steps = report.steps; });
    findings.equal(must, "two seconds later, asleep: steps in a frame", steps, 1);
}

}  // namespace

void runFastAndThin(const Context& context, Findings& findings)
{
    plate(context, findings);
    rod(context, findings);
    blade(context, findings);
    atRest(context, findings);
}

}  // namespace scree::verify
