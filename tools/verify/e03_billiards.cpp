// E3: the last of five touching balls leaves with all that the cue ball brought. [GBF03 figure 5],
// [A22–A24, A30]
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

void meshBalls(const Context& context, Findings& findings, double gap, const std::string& name)
{
    std::vector<std::string> overrides;
    for (int i = 0; i < 5; ++i) {
        overrides.push_back(setVector("body.ball_" + std::to_string(i) + ".position",
                                      {-4.0 + (2.0 + gap) * i, 1.0, 0.0}));
    }
    ShotRun run(context, "E03_billiards", overrides);
    run.advance(2.0, 240.0);
    double others = std::abs(run.motion("cue").velocity.x());
    for (int i = 0; i < 4; ++i) {
        others += std::abs(run.motion("ball_" + std::to_string(i)).velocity.x());
    }
    const double last = run.motion("ball_4").velocity.x();
    findings.atLeast(must, name + ": last ball", last, 19.0, "m/s");
    findings.atLeast(goal, name + ": last ball, goal", last, 19.8, "m/s");
    findings.atMost(must, name + ": sum of the others", others, 1.0, "m/s");
    findings.near(must, name + ": momentum", momenta(run.world).linear.x(), 20.0, 20.0 * 1e-10,
                  "kg m/s");
    if (gap == 0.0) addPicture(context, run, "Two seconds after the start", findings);
}

}  // namespace

void runBilliards(const Context& context, Findings& findings)
{
    meshBalls(context, findings, 0.0, "touching meshes of 1280 triangles");
    meshBalls(context, findings, 0.01, "meshes 1 cm apart");
    findings.notRun(must, "exact balls: velocities (0, 0, 0, 0, 0, 20) to 1e-9",
                    "this row is not written yet; tests/core holds the claim");
    findings.notRun(must, "rolling: the last ball slides, then rolls at 14.2857 m/s",
                    "this row is not written yet; tests/core holds the claim");
}

}  // namespace scree::verify
