// Energy that no step may create, of each step by itself: over a frame, what one step gains another
// may lose.
#pragma once

#include "core/scene/world.h"
#include "io/shot.h"

namespace scree::verify {

class StepEnergy {
public:
    StepEnergy(const World& world, const Vec3& gravity);

    /// After every step. `pushOutWork`: what the step says of itself, which is no gain [J].
    void look(const World& world, double pushOutWork);

    /// The steps of so many frames from `world` on, as the shot's settings choose them. Frames tell
    /// nothing of their steps: the steps of each are taken once more from where it began, one by
    /// one. For worlds without keys and births, whose clock is that of frames.
    void follow(World world, const Shot& shot, int frames);

    double largestRise = 0.0;  ///< in a step, of (kinetic energy + m g ℓ)
    double pushOutWork = 0.0;  ///< of all steps [J]
    int steps = 0;

private:
    Vec3 gravity_;
    double weightScale_ = 0.0;  // m g ℓ: what overlaps of the bodies' own thickness are worth [J]
    double before_ = 0.0;
};

}  // namespace scree::verify
