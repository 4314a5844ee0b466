// E18: shock propagation creates no momentum in a cluster that nothing supports. [A47]
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

struct Change {
    double linear = 0.0, angular = 0.0;  // largest in a second [kg m/s], [kg m²/s]
    std::int64_t impulses = 0;
};

double massOf(const World& world, std::size_t body)
{
    return 1.0 / world.mass[body].inverseMass;
}

/// What becomes of the momenta of the six, their weight apart.
Change follow(ShotRun& run, double stepsPerSecond)
{
    const double dt = 1.0 / stepsPerSecond;
    const Momenta before = momentaOf(run.start);
    Vec3 given = Vec3::Zero(), torque = Vec3::Zero();
    Change change;
    run.advance(1.0, stepsPerSecond, [&](const StepReport& report, double) {
        change.impulses += report.collisionImpulses.total() + report.contactImpulses.total() +
                           report.shockImpulses.total();
        for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
            // Gravity changes velocities before positions: where the body was, x - dt v.
            const BodyMotion& body = run.world.motion[b];
            const Vec3 weight = massOf(run.world, b) * run.shot.settings.gravity;
            given += dt * weight;
            torque += dt * (body.position - dt * body.velocity).cross(weight);
        }
        const Momenta now = momentaOf(run.world);
        change.linear = larger(change.linear, (now.linear - before.linear - given).norm());
        change.angular = larger(change.angular, (now.angular - before.angular - torque).norm());
    });
    return change;
}

std::string whyItChanges(const Context& context)
{
    if (context.method == "scree")
        return "weight acts where a body begins the step, whichever part of it the body falls: dt "
               "times velocity times weight is lost";
    return "a collision takes its lever arms at predicted positions (A22) but changes bodies where "
           "they are: dt times relative velocity times impulse is lost";
}

}  // namespace

void runFreeCluster(const Context& context, Findings& findings)
{
    for (double gravity : {0.0, -9.8}) {
        const std::string weight = setVector("shot.gravity", {0.0, gravity, 0.0});
        const std::string name = gravity == 0.0 ? "without weight: " : "falling: ";
        ShotRun coarse(context, "E18_cluster", {weight, "solver.push_out=false"});
        ShotRun fine(context, "E18_cluster", {weight, "solver.push_out=false"});
        const Change usual = follow(coarse, 240.0), small = follow(fine, 3840.0);
        findings.atLeast(must, name + "impulses", static_cast<double>(usual.impulses), 10.0, "");
        // Of what six bodies carry: the striker's 3 kg m/s, and what a second of fall gives them.
        const double allowed = 1e-12 * (3.0 + 6.0 * std::abs(gravity));
        findings.atMost(must, name + "momentum of the six changes", usual.linear, allowed, "kg m/s",
                        "1e-12 of what they carry");
        const std::string angular = name + "angular momentum of the six changes, ";
        if (context.method == "scree" && gravity == 0.0) {
            findings.atMost(must, angular + "240 Hz", usual.angular, 1e-12, "kg m^2/s");
            findings.atMost(must, angular + "3840 Hz", small.angular, 1e-12, "kg m^2/s");
        } else {
            findings.atMost(departure, angular + "240 Hz", usual.angular, 1e-12, "kg m^2/s",
                            whyItChanges(context));
            findings.atMost(must, name + "the same at 3840 Hz over at 240 Hz",
                            small.angular / usual.angular, 0.2, "-",
                            "first order in dt: 1/16 if the same points are struck");
        }
        ShotRun pushed(context, "E18_cluster", {weight});
        findings.atMost(must, name + "momentum of the six changes, with push-out",
                        follow(pushed, 240.0).linear, allowed, "kg m/s");
        if (gravity == 0.0) addPicture(context, coarse, "The cluster a second later", findings);
    }
    if (context.method != "paper") return;
    ShotRun strict(context, "E18_cluster",
                   {"shot.gravity=[0, -9.8, 0]", "solver.strict=true", "solver.push_out=false"});
    findings.atLeast(control, "falling, strict: momentum that freezing everything creates",
                     follow(strict, 240.0).linear, 1e-6, "kg m/s",
                     "shock takes the lowest of a free cluster for ground");
}

}  // namespace scree::verify
