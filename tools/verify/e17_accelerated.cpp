// E17: keyed bodies carry and push as lifts, turntables and rams do. [A36, A54]
#include <cmath>

#include "core/diagnostics/step_observer.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

void lift(const Context& context, Findings& findings)
{
    ShotRun run(context, "E17_lift");
    const BodyId lift = run.body("lift"), top = run.body("cube_0004");
    double drift = 0.0, lag = 0.0, fastest = 0.0;
    int otherLevels = 0;  // of steps: in a frame a lower one does not show
    LastStep last;
    run.stepper.observe(&last);
    const auto lookAtLevels = [&](const World&, double) {
        for (int i = 0; i < 5; ++i) {
            const BodyId cube = run.body("cube_000" + std::to_string(i));
            otherLevels += last.seen.level[cube] != i + 1;
        }
    };
    Curve ofLift{"lift", {}, {}, true}, ofTop{"uppermost cube", {}, {}, false};
    const auto lookAtFrame = [&](const FrameReport&) {
        for (int i = 0; i < 5; ++i) {
            const Vec3 x = run.motion("cube_000" + std::to_string(i)).position -
                           run.world.motion[lift].position;
            drift = larger(drift, std::hypot(x.x(), x.z()));
            lag = larger(lag, std::abs(x.y() - 0.2 * (i + 1)));
        }
        fastest = larger(fastest, run.world.motion[top].velocity.y());
        ofLift.x.push_back(static_cast<double>(ofLift.x.size() + 1) / 24.0);
        ofTop.x.push_back(ofLift.x.back());
        ofLift.y.push_back(run.world.motion[lift].velocity.y());
        ofTop.y.push_back(run.world.motion[top].velocity.y());
    };
    run.advanceFrames(5 * 24, lookAtFrame, lookAtLevels);
    findings.equal(must, "five cubes on a lift, +-2 m/s^2, 5 s: cubes on other levels, all steps",
                   otherLevels, 0);
    findings.atMost(must, "on the lift: drift", drift, 0.01, "m");
    findings.atMost(must, "on the lift: lag behind it", lag, 0.01, "m");
    findings.atLeast(must, "on the lift: its speed is felt at the top", fastest, 0.8, "m/s",
                     "the lift reaches 1 m/s");
    findings.plots.push_back({"Velocity on a lift", "time [s]", "velocity [m/s]", {ofTop, ofLift}});
}

/// How far from the axis the box gets in five seconds, watched until it has left its place.
double largestRadius(const Context& context, const char* shot)
{
    ShotRun run(context, shot);
    double radius = 0.0;
    for (int frame = 0; frame < 5 * 24 && radius <= 1.05; ++frame) {
        run.advanceFrames(1);
        const Vec3& x = run.motion("box").position;
        radius = larger(radius, std::hypot(x.x(), x.z()));
    }
    return radius;
}

void pusher(const Context& context, Findings& findings)
{
    ShotRun run(context, "E17_pusher");
    const BodyId box = run.body("box");
    run.advanceFrames(12);
    double off = 0.0, aside = 0.0;
    run.advanceFrames(36, {}, [&](const World& now, double) {
        const Vec3 unlike = now.motion[box].velocity - Vec3::UnitX();
        off = larger(off, std::abs(unlike.x()));
        aside = larger(aside, std::hypot(unlike.y(), unlike.z()));
    });
    findings.atMost(must, "box before a ram of 1 m/s, from 0.5 s to 2 s: speed off the ram's", off,
                    1e-6, "m/s");
    findings.report("box before a ram: speed aside", aside, "m/s");
}

}  // namespace

void runAcceleratedFrames(const Context& context, Findings& findings)
{
    lift(context, findings);
    findings.atMost(must, "box at 1 m on a turntable of 2.1 rad/s: gets as far as",
                    largestRadius(context, "E17_turntable"), 1.05, "m", "critical: 2.2136 rad/s");
    findings.atLeast(must, "the same at 2.3 rad/s: leaves, gets as far as",
                     largestRadius(context, "E17_turntable_fast"), 1.05, "m");
    pusher(context, findings);
}

}  // namespace scree::verify
