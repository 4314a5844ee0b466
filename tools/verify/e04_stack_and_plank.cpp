// E4: stacks stand, and a weight that falls on a plank throws up the boxes on its other end.
// [GBF03 figure 6], [A42, A43, A45]
#include <cmath>

#include "core/math/rotation.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"
#include "tools/verify/step_energy.h"

namespace scree::verify {
namespace {

using enum Weight;

struct StackResult {
    double sink = 0.0, drift = 0.0, speed = 0.0;  // of the top [m], of any cube [m], [m/s]
    int levels = 0;
};

/// All movable bodies of the run stand on each other.
StackResult stand(ShotRun& run, double seconds, bool hasDefaultSteps = false)
{
    StackResult result;
    const auto look = [&](int levels) {
        if (levels > 0) result.levels = levels;  // a stack asleep is no longer looked at
        result.speed = 0.0;
        for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
            if (!run.world.mass[b].isMovable()) continue;
            const BodyMotion& motion = run.world.motion[b];
            const Vec3 moved = motion.position - run.start.motion[b].position;
            result.drift = larger(result.drift, std::hypot(moved.x(), moved.z()));
            result.speed = larger(result.speed, motion.velocity.norm());
        }
    };
    if (hasDefaultSteps) {
        run.advanceFrames(static_cast<int>(std::lround(seconds * run.shot.framesPerSecond)),
                          [&](const FrameReport& report) { look(report.sum.levels); });
    } else {
        run.advance(seconds, 240.0, [&](const StepReport& report, double) { look(report.levels); });
    }
    BodyId top = 0;
    for (std::size_t b = 0; b < run.start.bodyCount(); ++b) {
        if (run.start.motion[b].position.y() > run.start.motion[top].position.y()) {
            top = static_cast<BodyId>(b);
        }
    }
    result.sink = run.start.motion[top].position.y() - run.world.motion[top].position.y();
    return result;
}

/// How far a cube has moved when 5 s are over, or when the stack has clearly fallen: a heap of
/// tumbling cubes takes long and shows no more.
double fall(ShotRun& run)
{
    double moved = 0.0;
    for (int quarter = 0; quarter < 20 && moved < 0.3; ++quarter) {
        const StackResult result = stand(run, 0.25);
        moved = larger(moved, larger(result.drift, std::abs(result.sink)));
    }
    return moved;
}

void addStackRows(const std::string& name, const StackResult& result, Findings& findings)
{
    findings.atMost(must, name + ": top sinks", std::abs(result.sink), 2e-3, "m");
    findings.atMost(must, name + ": drift", result.drift, 5e-3, "m");
    findings.atMost(must, name + ": speed at the end", result.speed, 5e-3, "m/s");
    findings.equal(must, name + ": levels", result.levels, 11);
}

void stacks(const Context& context, Findings& findings)
{
    const std::vector<int> seeds = context.isFull() ? std::vector{1, 7, 19} : std::vector{7};
    for (int seed : seeds) {
        ShotRun ten(context, "E04_stack_10", {"shot.seed=" + std::to_string(seed)});
        addStackRows("ten aligned cubes, seed " + std::to_string(seed), stand(ten, 5.0), findings);
    }
    ShotRun exact(context, "E04_stack_10", asExactSolids({"cube"}));
    addStackRows("ten exact boxes", stand(exact, context.isFull() ? 5.0 : 2.0), findings);
    ShotRun usual(context, "E04_stack_10", withDefaultSteps());
    addStackRows("ten cubes, steps as by default", stand(usual, context.isFull() ? 5.0 : 2.0, true),
                 findings);
    ShotRun twenty(context, "E04_stack_20");
    const StackResult result = stand(twenty, 5.0);
    findings.atMost(must, "twenty offset cubes: drift", result.drift, 0.1, "m");
    findings.atMost(goal, "twenty offset cubes: drift, goal", result.drift, 0.01, "m");
    findings.atMost(must, "twenty offset cubes: top sinks", std::abs(result.sink), 0.01, "m");
    addPicture(context, twenty, "Twenty cubes, up to 5 cm off the axis, after 5 s", findings);

    ShotRun unaided(context, "E04_stack_20", {"solver.shock_propagation=false"});
    findings.atLeast(context.controlOfPaper(),
                     "the same without shock propagation: moves within 5 s", fall(unaided), 0.25,
                     "m");
    addPicture(context, unaided, "Control: the same without shock propagation", findings);

    if (!context.isFull()) return;
    ShotRun corners(context, "E04_stack_10", {"shape.cube.box.segments=[1, 1, 1]"});
    findings.atMost(goal, "ten aligned cubes of eight vertices: movement within 5 s", fall(corners),
                    5e-3, "m", "no vertex lies in a neighbour's face");
}

struct PlankResult {
    double driftBefore = 0.0, tilt = 0.0, rise = 0.0;
    double tiltRate = 0.0;  // largest within a tenth of a second after the impact [rad/s]
};

constexpr double kImpact = 1.0102;  // the weight has fallen 5 m [s]

class PlankWatch {
public:
    explicit PlankWatch(const ShotRun& run) : run_(run), plank_(run.body("plank"))
    {
        for (const BodyInfo& info : run.world.info) {
            if (info.name.starts_with("box_")) boxes_.push_back(run.body(info.name));
        }
    }

    void look(double time)
    {
        for (BodyId b : boxes_) {
            const Vec3 moved = run_.world.motion[b].position - run_.start.motion[b].position;
            if (time < kImpact - 0.01) {
                result.driftBefore = larger(result.driftBefore, moved.norm());
            }
            result.rise = larger(result.rise, moved.y());
        }
        const Vec3 along = run_.world.worldFromAsset(plank_).orientation * Vec3::UnitX();
        if (time < kImpact + 1.5) {
            result.tilt = larger(result.tilt, -std::asin(along.y()) * 180.0 / kPi);
        }
        if (time > kImpact && time < kImpact + 0.1) {
            result.tiltRate = larger(result.tiltRate, spinOf(run_.world, plank_).norm());
        }
    }

    PlankResult result;

private:
    const ShotRun& run_;
    BodyId plank_;
    std::vector<BodyId> boxes_;
};

void addPlankRows(const std::string& name, const PlankResult& result, const StepEnergy& energy,
                  Findings& findings)
{
    findings.atMost(must, name + ": boxes move before the impact", result.driftBefore, 0.01, "m");
    findings.atLeast(must, name + ": tilts within 1.5 s", result.tilt, 30.0, "degrees");
    findings.atLeast(must, name + ": a box rises", result.rise, 1.0, "m");
    findings.atMost(must, name + ": energy rises in a step", energy.largestRise, 1e-3,
                    "of (kinetic + m g l)", "work of push-out apart");
    findings.report(name + ": work of push-out", energy.pushOutWork, "J");
}

void throwUp(const Context& context, const std::vector<std::string>& overrides,
             const std::string& name, Findings& findings)
{
    ShotRun run(context, "E04_plank", overrides);
    PlankWatch watch(run);
    StepEnergy energy(run.world, run.shot.settings.gravity);
    double time = 0.0;
    const auto look = [&](const StepReport& report, double) {
        time += report.dt;
        watch.look(time);
        energy.look(run.world, report.pushOutWork);
    };
    run.advance(1.4, 240.0, look);
    addPicture(context, run, name + ", 0.4 s after the impact", findings);
    run.advance(1.1, 240.0, look);
    addPlankRows(name, watch.result, energy, findings);
}

void plank(const Context& context, Findings& findings)
{
    throwUp(context, {}, "plank", findings);
    if (!context.isFull()) return;
    throwUp(context, asExactSolids({"cube", "base", "plank", "weight"}), "plank, exact boxes",
            findings);
    constexpr int kFrames = 60;
    ShotRun usual(context, "E04_plank", withDefaultSteps());
    PlankWatch watch(usual);
    double time = 0.0;
    usual.advanceFrames(kFrames, [&](const FrameReport&) {
        time += 1.0 / usual.shot.framesPerSecond;
        watch.look(time);
    });
    StepEnergy energy(usual.start, usual.shot.settings.gravity);
    energy.follow(usual.start, usual.shot, kFrames);
    addPlankRows("plank, steps as by default", watch.result, energy, findings);
}

/// With the plank's centre over the base it does not tip by itself, so that only the weight of what
/// is on it can turn it.
const std::string kCentred = "body.plank.position=[1, 4.25, 0]";

void impactControl(const Context& context, Findings& findings)
{
    ShotRun whole(context, "E04_plank", {kCentred});
    ShotRun weightless(context, "E04_plank",
                       {kCentred, "solver.contact_iterations=0", "solver.collision_iterations=0"});
    PlankWatch seen(whole), unseen(weightless);
    whole.advance(1.15, 240.0, [&](const StepReport&, double t) { seen.look(t); });
    weightless.advance(1.15, 240.0, [&](const StepReport&, double t) { unseen.look(t); });
    findings.atMost(context.controlOfPaper(),
                    "impact, shock alone, no collisions: tilt rate over the full run's",
                    unseen.result.tiltRate / seen.result.tiltRate, 0.1, "-",
                    "the falling weight rests on the plank, not the plank on it: frozen first, the "
                    "plank feels nothing");
}

/// The heavy box stands on the plank from the start: its weight alone, no impact.
double spinUnderWeight(const Context& context, int contactIterations)
{
    ShotRun run(context, "E04_plank",
                {kCentred, "body.weight.position=[5.0, 5.5, 0]",
                 "solver.contact_iterations=" + std::to_string(contactIterations)});
    run.advance(0.2, 240.0);
    return spinOf(run.world, run.body("plank")).norm();
}

void weightControl(const Context& context, Findings& findings)
{
    findings.atMost(context.controlOfPaper(),
                    "heavy box on the plank, shock alone: tilt rate over the full run's",
                    spinUnderWeight(context, 0) / spinUnderWeight(context, 10), 0.1, "-",
                    "shock alone makes bodies weightless for what carries them");
}

}  // namespace

void runStackAndPlank(const Context& context, Findings& findings)
{
    stacks(context, findings);
    plank(context, findings);
    impactControl(context, findings);
    weightControl(context, findings);
}

}  // namespace scree::verify
