#include "tools/verify/step_energy.h"

#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "tools/stop_signals.h"
#include "tools/verify/findings.h"

namespace scree::verify {

StepEnergy::StepEnergy(const World& world, const Vec3& gravity) : gravity_(gravity)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        weightScale_ += gravity.norm() * world.shapeOf(static_cast<BodyId>(b)).innerThickness /
                        world.mass[b].inverseMass;
    }
    before_ = mechanicalEnergy(world, gravity_);
}

void StepEnergy::look(const World& world, double workOfPushOut)
{
    const double now = mechanicalEnergy(world, gravity_);
    const double rise = now - before_ - workOfPushOut;
    largestRise = larger(largestRise, rise / (kineticEnergy(world) + weightScale_));
    pushOutWork += workOfPushOut;
    before_ = now;
    ++steps;
}

void StepEnergy::follow(World world, const Shot& shot, int frames)
{
    Stepper stepper(shot.settings);
    for (int frame = 0; frame < frames; ++frame) {
        World again = world;
        std::vector<double> lengths;
        double reached = 0.0;
        stepper.advanceFrame(world, 1.0 / shot.framesPerSecond, stopRequested,
                             [&](const World&, double time) {
                                 lengths.push_back(time - reached);
                                 reached = time;
                             });
        heedStop("the experiments were not run to their end");
        before_ = mechanicalEnergy(again, gravity_);
        Stepper oneByOne(shot.settings);
        for (double dt : lengths) {
            const StepReport report = oneByOne.step(again, dt);
            look(again, report.pushOutWork);
        }
    }
}

}  // namespace scree::verify
