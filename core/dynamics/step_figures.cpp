#include "core/dynamics/step_figures.h"

#include <algorithm>

#include "core/diagnostics/state_hash.h"
#include "core/dynamics/integrator.h"

namespace scree {

double kineticEnergy(const World& world)
{
    double energy = 0.0;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (world.mass[b].isMovable()) energy += kineticEnergy(world.motion[b], world.mass[b]);
    }
    return energy;
}

double potentialEnergy(const World& world, const Vec3& gravity)
{
    double energy = 0.0;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        energy -= gravity.dot(world.motion[b].position) / world.mass[b].inverseMass;
    }
    return energy;
}

double mechanicalEnergy(const World& world, const Vec3& gravity)
{
    return kineticEnergy(world) + potentialEnergy(world, gravity);
}

Momenta momentaOf(const World& world)
{
    Momenta sum;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        const BodyMotion& motion = world.motion[b];
        const Vec3 momentum = motion.velocity / world.mass[b].inverseMass;
        sum.linear += momentum;
        sum.angular += motion.position.cross(momentum) + motion.angularMomentum;
    }
    return sum;
}

void findNonFinite(const World& world, Phase phase, StepReport& report)
{
    if (!report.nonFinite.empty()) return;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const BodyMotion& m = world.motion[b];
        const bool isFinite = m.position.allFinite() && m.orientation.coeffs().allFinite() &&
                              m.velocity.allFinite() && m.angularMomentum.allFinite();
        if (!isFinite) report.nonFinite.push_back(static_cast<BodyId>(b));
    }
    report.nonFinitePhase = phase;
}

void describeGraph(const ContactGraph& graph, const StepScratch& scratch, StepReport& report)
{
    report.broadPairs = static_cast<std::int64_t>(scratch.pairCount);
    report.contactPairs = graph.contactPairs;
    report.levels = static_cast<int>(graph.contact.size());
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        report.touchingPairs += scratch.pairs[i].isTouched;
    }
    for (std::size_t l = 1; l < graph.contact.size(); ++l) {
        report.largestLevel = std::max(report.largestLevel, graph.contact[l].bodies);
    }
}

void describeOverlap(const WorstOverlap& worst, StepReport& report)
{
    report.deepestAfterPushOut = worst.depth;
    report.worstOverlapRatio = worst.ratio;
    report.worstA = worst.a;
    report.worstB = worst.b;
}

void addFigures(const StepReport& step, StepReport& sum)
{
    sum.dt += step.dt;
    sum.broadPairs = std::max(sum.broadPairs, step.broadPairs);
    sum.touchingPairs = std::max(sum.touchingPairs, step.touchingPairs);
    sum.contactPairs = std::max(sum.contactPairs, step.contactPairs);
    sum.contacts = std::max(sum.contacts, step.contacts);
    sum.levels = std::max(sum.levels, step.levels);
    sum.largestLevel = std::max(sum.largestLevel, step.largestLevel);
    sum.collisionImpulses += step.collisionImpulses;
    sum.contactImpulses += step.contactImpulses;
    sum.shockImpulses += step.shockImpulses;
    sum.pushes += step.pushes;
    sum.loopsAtTheirCap += step.loopsAtTheirCap;
    sum.pushesCut += step.pushesCut;
    sum.pushOutWork += step.pushOutWork;
    sum.deepestBeforePushOut = std::max(sum.deepestBeforePushOut, step.deepestBeforePushOut);
    sum.deepestAfterPushOut = std::max(sum.deepestAfterPushOut, step.deepestAfterPushOut);
    if (step.worstOverlapRatio > sum.worstOverlapRatio) {
        sum.worstOverlapRatio = step.worstOverlapRatio;
        sum.worstA = step.worstA;
        sum.worstB = step.worstB;
    }
    for (std::size_t p = 0; p < sum.seconds.size(); ++p) sum.seconds[p] += step.seconds[p];
}

void addStep(const StepReport& step, FrameReport& frame)
{
    StepReport& sum = frame.sum;
    if (frame.steps == 0 || step.dt < frame.shortestStep) {
        frame.shortestStep = step.dt;
        sum.limitedBy = step.limitedBy;
    }
    frame.longestStep = std::max(frame.longestStep, step.dt);
    ++frame.steps;
    addFigures(step, sum);
    sum.nonFinite = step.nonFinite;
    sum.nonFinitePhase = step.nonFinitePhase;
}

void describeState(const World& world, const Vec3& gravity, FrameReport& report)
{
    report.potentialEnergy = potentialEnergy(world, gravity);
    report.kineticEnergy = kineticEnergy(world);
    const Momenta momenta = momentaOf(world);
    report.momentum = momenta.linear;
    report.angularMomentum = momenta.angular;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        if (!world.contactMemory.isAsleep(static_cast<BodyId>(b))) ++report.bodiesAwake;
    }
    report.stateHash = stateHash(world);
}

FrameReport reportStart(const World& world, const Vec3& gravity)
{
    FrameReport report;
    describeState(world, gravity, report);
    for (const PlannedBirth& birth : world.births) {
        report.births.born += world.isBorn(birth.body);
        report.births.skipped += world.bornAt[birth.body] == kSkipped;
        report.births.waiting += birth.frame <= world.clock.frame && !world.isBorn(birth.body) &&
                                 world.bornAt[birth.body] != kSkipped;
    }
    return report;
}

}  // namespace scree
