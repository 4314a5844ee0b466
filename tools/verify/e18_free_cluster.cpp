// E18: shock propagation creates no momentum in a cluster that nothing supports. [A47]
#include <algorithm>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {

using enum Weight;

void runFreeCluster(const Context& context, Findings& findings)
{
    for (double gravity : {0.0, -9.8}) {
        ShotRun run(context, "E18_cluster", {setVector("shot.gravity", {0.0, gravity, 0.0})});
        const Momenta before = momenta(run.start);
        double linear = 0.0, angular = 0.0, mass = 0.0;
        std::int64_t impulses = 0;
        Vec3 centre = Vec3::Zero();
        for (std::size_t b = 0; b < run.start.bodyCount(); ++b) {
            mass += 1.0 / run.start.mass[b].inverseMass;
            centre += run.start.motion[b].position / run.start.mass[b].inverseMass;
        }
        centre /= mass;
        const double dt = 1.0 / 240.0;
        Vec3 weightTorque = Vec3::Zero();
        run.advance(1.0, 240.0, [&](const StepReport& report, double t) {
            impulses += report.collisionImpulses.total() + report.contactImpulses.total() +
                        report.shockImpulses.total();
            // Weight acts at the common centre as it was when the step began.
            const Vec3 weight(0.0, gravity * mass, 0.0);
            weightTorque += dt * centre.cross(weight);
            centre = Vec3::Zero();
            for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
                centre += run.world.motion[b].position / run.world.mass[b].inverseMass / mass;
            }
            const Momenta now = momenta(run.world);
            linear = std::max(linear, (now.linear - before.linear - t * weight).norm());
            angular = std::max(angular, (now.angular - before.angular - weightTorque).norm());
        });
        const std::string name = gravity == 0.0 ? "without weight: " : "falling: ";
        findings.atLeast(must, name + "impulses", static_cast<double>(impulses), 10.0, "");
        findings.atMost(must, name + "momentum of the six changes", linear, 1e-12 * (3.0 + 60.0),
                        "kg m/s", "relative to what six bodies carry");
        findings.atMost(must, name + "angular momentum changes", angular, 1e-10, "kg m^2/s",
                        "push-out is frictionless but moves mass: its share is in it");
        if (gravity == 0.0) addPicture(context, run, "The cluster a second later", findings);
    }
    findings.notRun(goal, "strict: the momentum that freezing everything creates",
                    "solver.strict is not in this version");
}

}  // namespace scree::verify
