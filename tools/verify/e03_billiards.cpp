// E3: the last of five touching balls leaves with all that the cue ball brought. [GBF03 figure 5],
// [A9, A22–A25, A30, A40]
#include <algorithm>
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

const char* const kLine[] = {"ball_0", "ball_1", "ball_2", "ball_3", "ball_4"};
const std::string kExact = "shape.ball.collide=\"exact\"";

std::vector<std::string> lineWithGaps(double gap)
{
    std::vector<std::string> overrides;
    for (int i = 0; i < 5; ++i) {
        overrides.push_back(setVector(std::string("body.") + kLine[i] + ".position",
                                      {-4.0 + (2.0 + gap) * i, 1.0, 0.0}));
    }
    return overrides;
}

double fastestOfTheOthers(const ShotRun& run)
{
    double fastest = run.motion("cue").velocity.norm();
    for (int i = 0; i < 4; ++i) fastest = larger(fastest, run.motion(kLine[i]).velocity.norm());
    return fastest;
}

/// Speeds of all but the last ball, summed.
double othersOf(const ShotRun& run)
{
    double sum = run.motion("cue").velocity.norm();
    for (int i = 0; i < 4; ++i) sum += run.motion(kLine[i]).velocity.norm();
    return sum;
}

void meshBalls(const Context& context, Findings& findings, double gap, const std::string& name)
{
    ShotRun run(context, "E03_billiards", lineWithGaps(gap));
    run.advance(2.0, 240.0);
    const double last = run.motion("ball_4").velocity.x();
    findings.atLeast(must, name + ": last ball", last, 19.0, "m/s");
    findings.atLeast(goal, name + ": last ball, goal", last, 19.8, "m/s");
    findings.atMost(must, name + ": sum of the others", othersOf(run), 1.0, "m/s");
    findings.near(must, name + ": momentum", momentaOf(run.world).linear.x(), 20.0, 20.0 * 1e-10,
                  "kg m/s");
}

void exactBalls(const Context& context, Findings& findings, double gap,
                const std::string& collision, const std::string& name)
{
    std::vector<std::string> overrides = lineWithGaps(gap);
    overrides.push_back(kExact);
    overrides.push_back("solver.collision=\"" + collision + "\"");
    ShotRun run(context, "E03_billiards", overrides);
    const bool isShown = gap == 0.0 && collision == "reevolve";
    run.advance(0.1, 240.0);
    if (isShown) addPicture(context, run, "The cue ball arrives from the left", findings);
    run.advance(0.6, 240.0);
    if (isShown) addPicture(context, run, "Half a second later only the last one moves", findings);
    run.advance(1.3, 240.0);
    const double fastest = fastestOfTheOthers(run);
    const Vec3 last = run.motion("ball_4").velocity;
    double energy = 0.0;
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        energy += 0.5 * run.world.motion[b].velocity.squaredNorm();
    }
    findings.near(must, name + ": last ball", last.x(), 20.0, 1e-9, "m/s");
    findings.atMost(must, name + ": last ball, off the line", std::hypot(last.y(), last.z()), 1e-9,
                    "m/s");
    findings.atMost(must, name + ": fastest of the others", fastest, 1e-9, "m/s");
    findings.near(must, name + ": momentum", momentaOf(run.world).linear.x(), 20.0, 20.0 * 1e-10,
                  "kg m/s");
    findings.near(must, name + ": energy", energy, 200.0, 200.0 * 1e-10, "J");
}

/// The line on a floor with friction, the cue ball released 5 cm before it.
std::vector<std::string> roughFloor()
{
    return {kExact, "material.floor.friction=0.3",
            setVector("body.cue.position", {-6.05, 1.0, 0.0})};
}

/// Velocity of the ball's lowest point.
Vec3 slipOfTheLast(const ShotRun& run)
{
    const Vec3 toFloor(0.0, -1.0, 0.0);
    return run.motion("ball_4").velocity + spinOf(run.world, run.body("ball_4")).cross(toFloor);
}

/// `rollsAt`: when it was seen to slip last.
Curve speedOfTheLast(ShotRun& run, double seconds, double* rollsAt = nullptr)
{
    Curve curve;
    run.advance(seconds, 240.0, [&](const StepReport&, double t) {
        curve.x.push_back(t);
        curve.y.push_back(run.motion("ball_4").velocity.x());
        if (rollsAt && slipOfTheLast(run).norm() > 1e-3) *rollsAt = t;
    });
    return curve;
}

/// It slides at 20 m/s, braked by 0.3 g, and rolls at 5/7 of that from 1.944 s on.
Curve slideThenRoll()
{
    Curve curve{"theory", {}, {}, true};
    for (int k = 0; k <= 600; ++k) {
        const double t = 0.01 * k;
        curve.x.push_back(t);
        curve.y.push_back(std::max(20.0 - 0.3 * 9.8 * t, 100.0 / 7.0));
    }
    return curve;
}

void rollingBalls(const Context& context, Findings& findings)
{
    ShotRun run(context, "E03_billiards", roughFloor());
    double rollsAt = 0.0;
    Curve speed = speedOfTheLast(run, 2.5, &rollsAt);
    const double struckAt = 0.05 / 20.0, slides = 2.0 * 20.0 / (7.0 * 0.3 * 9.8);
    findings.near(must, "rolling: the last ball slips no more at", rollsAt, struckAt + slides,
                  0.01 * slides, "s");
    addPicture(context, run, "Rough floor, 2.5 s after the start: the last ball is on its way",
               findings);
    for (double seconds : {2.5, 6.0}) {
        if (seconds > 2.5) {
            const Curve rest = speedOfTheLast(run, seconds - 2.5);
            for (std::size_t i = 0; i < rest.x.size(); ++i) {
                speed.x.push_back(2.5 + rest.x[i]);
                speed.y.push_back(rest.y[i]);
            }
        }
        const std::string name = "rolling, after " + shortNumber(seconds) + " s: ";
        const double v = run.motion("ball_4").velocity.x();
        const double slip = slipOfTheLast(run).norm();
        findings.near(must, name + "last ball", v, 100.0 / 7.0, 0.01 * 100.0 / 7.0, "m/s");
        findings.atMost(must, name + "slip of the last ball", slip, 1e-3, "m/s");
        findings.atMost(must, name + "fastest of the others", fastestOfTheOthers(run), 0.1, "m/s");
    }
    speed.name = "measured";
    Plot plot{"Speed of the last ball on a floor of friction 0.3", "time [s]", "speed [m/s]", {}};
    plot.curves.push_back(speed);
    if (context.method == "paper") {
        ShotRun braked(context, "E03_billiards", roughFloor(),
                       [](StepSettings& settings) { settings.slideSmoothSamples = false; });
        Curve control = speedOfTheLast(braked, 6.0);
        findings.atMost(Weight::control,
                        "rolling on material points (A40 left out), 6 s: last ball",
                        control.y.back(), 13.5, "m/s", "the point that will touch next brakes");
        control.name = "control: without A40";
        plot.curves.push_back(control);
    }
    plot.curves.push_back(slideThenRoll());
    findings.plots.push_back(plot);
}

}  // namespace

void runBilliards(const Context& context, Findings& findings)
{
    exactBalls(context, findings, 0.0, "reevolve", "exact balls, touching");
    exactBalls(context, findings, 0.01, "reevolve", "exact balls 1 cm apart");
    exactBalls(context, findings, 0.0, "lagged", "exact balls, lagged");
    meshBalls(context, findings, 0.0, "touching meshes of 1280 triangles");
    meshBalls(context, findings, 0.01, "meshes 1 cm apart");
    rollingBalls(context, findings);
}

}  // namespace scree::verify
