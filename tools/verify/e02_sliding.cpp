// E2: a block slides as Coulomb says, speeding up and slowing down. [GBF03 figure 4],
// [A17, A18, A31, A32, A41]
#include <cmath>

#include "tools/verify/controls.h"
#include "tools/verify/experiments.h"
#include "tools/verify/incline.h"

namespace scree::verify {
namespace {

using enum Weight;

struct Slope {
    const char* shot;
    const char* name;
    SlideTheory theory;
};

const Slope kSlopes[] = {{"E02_accelerating", "accelerating", {30.0, 0.3, 0.0}},
                         {"E02_decelerating", "decelerating", {15.0, 0.5, 4.0}}};

void againstTheory(const Context& context, Findings& findings)
{
    for (const Slope& slope : kSlopes) {
        for (const auto& [rate, share] : {std::pair{240.0, 0.005}, std::pair{1000.0, 0.001}}) {
            ShotRun run(context, slope.shot);
            const SlideErrors errors = slide(run, slope.theory, rate);
            addSlideRows(std::string(slope.name) + ", " + shortNumber(rate) + " Hz", errors, share,
                         findings);
            if (rate != 240.0) continue;
            findings.plots.push_back({std::string("Distance slid, ") + slope.name + ", 240 Hz",
                                      "time [s]",
                                      "distance [m]",
                                      {errors.measured, errors.theory}});
            addPicture(context, run, std::string("The ") + slope.name + " block after 2 s",
                       findings);
        }
    }
}

void exactAndDefaults(const Context& context, Findings& findings)
{
    for (const Slope& slope : kSlopes) {
        ShotRun exact(context, slope.shot, asExactSolids({"block"}));
        addSlideRows(std::string(slope.name) + ", exact box, 240 Hz",
                     slide(exact, slope.theory, 240.0), 0.005, findings);
        ShotRun usual(context, slope.shot, withDefaultSteps());
        const SlideErrors errors = slideInFrames(usual, slope.theory);
        const std::string name = std::string(slope.name) + ", steps as by default: ";
        findings.atMost(must, name + "error of the distance", errors.position,
                        0.005 * errors.distance, "m");
        findings.atMost(must, name + "rotation", errors.rotation, 1e-3, "rad");
        if (slope.theory.startSpeed > 0.0) {
            findings.atMost(must, name + "speed after it stopped", errors.restSpeed, 1e-8, "m/s");
        }
    }
}

void orderOfTheError(const Context& context, Findings& findings)
{
    if (context.method != "paper") return;  // the other has none to speak of
    const Slope& slope = kSlopes[0];
    ShotRun coarse(context, slope.shot), fine(context, slope.shot);
    const double ratio =
        slide(coarse, slope.theory, 240.0).position / slide(fine, slope.theory, 960.0).position;
    findings.near(must, "error at dt over error at dt/4", ratio, 4.0, 0.4, "-",
                  "first order in dt");
}

void textbookOrder(const Context& context, Findings& findings)
{
    for (const Slope& slope : kSlopes) {
        ShotRun run(context, slope.shot);
        const BodyId block = run.body("block");
        for (int k = 0; k < 2 * 60; ++k) {
            textbookStep(run.world, run.shot.settings, 1.0 / 60.0);
        }
        const Vec3 moved = run.world.motion[block].position - run.start.motion[block].position;
        const double error =
            std::abs(moved.dot(slope.theory.downhill()) - slope.theory.distance(2.0));
        findings.atLeast(control,
                         std::string("textbook order, ") + slope.name + ": error after 2 s", error,
                         0.1, "m");
    }
}

}  // namespace

void runSliding(const Context& context, Findings& findings)
{
    againstTheory(context, findings);
    exactAndDefaults(context, findings);
    orderOfTheError(context, findings);
    textbookOrder(context, findings);
}

}  // namespace scree::verify
