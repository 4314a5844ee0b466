// What a step tells of itself, gathered from what its passes leave behind. Nothing here moves a
// body.  [A58, A59]
#pragma once

#include "core/diagnostics/step_report.h"
#include "core/dynamics/contact_graph.h"

namespace scree {

/// Of the movable bodies [J].
double kineticEnergy(const World& world);

/// Of the movable bodies; zero at the height of the world's origin [J].
double potentialEnergy(const World& world, const Vec3& gravity);

/// Both together [J].
double mechanicalEnergy(const World& world, const Vec3& gravity);

struct Momenta {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  ///< [kg m/s], [kg m²/s] about the origin
};

/// Of the movable bodies together.
Momenta momentaOf(const World& world);

/// Names the bodies whose state is no number, unless an earlier phase had some already.
void findNonFinite(const World& world, Phase phase, StepReport& report);

/// Pairs and levels of a step of method `paper`.
void describeGraph(const ContactGraph& graph, const StepScratch& scratch, StepReport& report);

/// The deepest overlap that the step leaves.
void describeOverlap(const WorstOverlap& worst, StepReport& report);

/// Takes a step into the figures of its frame: sums, or the worst so far.
void addStep(const StepReport& step, FrameReport& frame);

/// Counts, work and seconds summed, all else the largest; who limited a step and what is no longer
/// a number are left as they are.
void addFigures(const StepReport& step, StepReport& sum);

/// Energies, momenta, who is awake and the hash, of the world as it is. `gravity` in [m/s²].
void describeState(const World& world, const Vec3& gravity, FrameReport& report);

/// The figures of a world that no step has moved yet: those of its state, and who was born where it
/// begins.
FrameReport reportStart(const World& world, const Vec3& gravity);

}  // namespace scree
