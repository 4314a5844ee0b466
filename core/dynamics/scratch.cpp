#include "core/dynamics/scratch.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/integrator.h"

namespace scree {
namespace {

/// One record for each of the pairs found; those that had one keep it and what it remembers.
template <class OnNew>
void layOutPairs(const std::vector<BodyPair>& found, StepScratch& scratch, const OnNew& onNew)
{
    std::swap(scratch.pairs, scratch.formerPairs);
    if (scratch.pairs.size() < found.size()) scratch.pairs.resize(found.size());
    std::size_t former = 0;  // both lists are sorted
    for (std::size_t i = 0; i < found.size(); ++i) {
        while (former < scratch.pairCount && scratch.formerPairs[former].bodies < found[i])
            ++former;
        PairRecord& record = scratch.pairs[i];
        if (former < scratch.pairCount && scratch.formerPairs[former].bodies == found[i]) {
            std::swap(record, scratch.formerPairs[former++]);
            continue;
        }
        record.bodies = found[i];
        record.proximity.forget();
        onNew(record);
    }
    scratch.pairCount = found.size();
}

void describePair(const World& world, const StepSettings& settings, PairRecord& record)
{
    const BodyPair bodies = record.bodies;
    record.tau = contourValue(world.shapeOf(bodies.a), world.shapeOf(bodies.b));
    const PairSurface surface = surfaceOf(world, settings, bodies);
    record.friction = surface.friction;
    record.restitution = surface.restitution;
    record.rolling = surface.rolling;
    record.aIsUnmoved = isUnmovedBy(world, bodies.a, bodies.b);
    record.bIsUnmoved = isUnmovedBy(world, bodies.b, bodies.a);
    record.interferesNow = record.isTouched = false;
    record.aFallsOnB = record.bFallsOnA = record.aLeavesB = record.bLeavesA = false;
}

double speedOfSurface(const World& world, BodyId body)
{
    return angularVelocity(world.motion[body], world.mass[body]).norm() *
           world.shapeOf(body).boundingRadius;
}

/// How far a pair may move before it looks for near samples again: what it will move in a few steps
/// if nothing happens, and a little, as a share of the thinner body. Only a matter of speed.
double lookMargin(const World& world, const StepSettings& settings, BodyPair bodies, double dt)
{
    const double speed =
        (world.motion[bodies.a].velocity - world.motion[bodies.b].velocity).norm() +
        speedOfSurface(world, bodies.a) + speedOfSurface(world, bodies.b);
    const double thinner =
        std::min(world.shapeOf(bodies.a).thickness(), world.shapeOf(bodies.b).thickness());
    constexpr double kLeastMargin = 1e-3, kStepsAhead = 8.0;
    return std::max(kLeastMargin * thinner,
                    kStepsAhead * dt * (speed + dt * settings.gravity.norm()));
}

void beginPair(const World& world, const StepSettings& settings, double dt, bool isWatched,
               PairRecord& pair)
{
    pair.proximity.setMargin(lookMargin(world, settings, pair.bodies, dt));
    pair.isWatched = isWatched;
    pair.impulses.clear();
    pair.depth = 0.0;
    pair.searched = pair.quiet = {};
}

/// Order of processing: by the place of the later body in World::order, then of the earlier.  [A21]
void sortPairs(const World& world, StepScratch& scratch)
{
    scratch.rank.resize(world.bodyCount());
    for (std::size_t place = 0; place < world.order.size(); ++place) {
        scratch.rank[world.order[place]] = place;
    }
    scratch.pairOrder.resize(scratch.pairCount);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) scratch.pairOrder[i] = i;
    std::sort(scratch.pairOrder.begin(), scratch.pairOrder.end(),
              [&](std::size_t p, std::size_t q) {
                  const auto key = [&](std::size_t pair) {
                      const std::size_t a = scratch.rank[scratch.pairs[pair].bodies.a];
                      const std::size_t b = scratch.rank[scratch.pairs[pair].bodies.b];
                      return std::pair(std::max(a, b), std::min(a, b));
                  };
                  return key(p) < key(q);
              });
}

}  // namespace

void findPairs(const World& world, const StepSettings& settings, double remaining,
               StepScratch& scratch)
{
    findForces(world, settings, remaining, scratch.forces);
    findCandidates(world, scratch.forces, remaining, scratch.candidates);
    layOutPairs(scratch.candidates.pairs, scratch, [](PairRecord&) {});
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        describePair(world, settings, scratch.pairs[i]);
    }
}

void beginStep(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    const std::size_t bodies = world.bodyCount();
    findForces(world, settings, dt, scratch.forces);
    scratch.moves.assign(bodies, 0);
    scratch.inertia.resize(bodies);
    scratch.fallPose.resize(bodies);
    scratch.driftPose.resize(bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
        scratch.inertia[b] = passInertia(world.mass[b], world.motion[b].orientation);
        scratch.driftPose[b] = scratch.fallPose[b] =
            poseAfter(world, settings, static_cast<BodyId>(b), dt);
        predictBody(world, settings, dt, static_cast<BodyId>(b), scratch);
    }
    for (std::size_t i = 0; i < scratch.pairCount; ++i)
        beginPair(world, settings, dt, scratch.isWatched, scratch.pairs[i]);
    sortPairs(world, scratch);
}

void widenPairs(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    scratch.reached.resize(world.bodyCount());
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const Shape& shape = world.shapeOf(static_cast<BodyId>(b));
        scratch.reached[b] = boxAt(shape, scratch.fallPose[b]);
        scratch.reached[b].include(boxAt(shape, scratch.driftPose[b]));
    }
    if (!widenCandidates(world, scratch.forces, scratch.reached, 2.0 * dt, scratch.candidates))
        return;
    layOutPairs(scratch.candidates.pairs, scratch, [&](PairRecord& pair) {
        describePair(world, settings, pair);
        beginPair(world, settings, dt, scratch.isWatched, pair);
    });
    sortPairs(world, scratch);
}

void predictAfterImpulse(const World& world, const StepSettings& settings, double dt,
                         BodyPair bodies, StepScratch& scratch)
{
    for (const BodyId body : {bodies.a, bodies.b}) {
        // A body that cannot be moved is shared by threads: it is not even written to.
        if (!world.mass[body].isMovable()) continue;
        predictBody(world, settings, dt, body, scratch);
        ++scratch.moves[body];
    }
}

void predictBody(const World& world, const StepSettings& settings, double dt, BodyId body,
                 StepScratch& scratch)
{
    const BodyMotion& motion = world.motion[body];
    const BodyMass& mass = world.mass[body];
    if (!mass.isMovable()) return;
    scratch.driftPose[body] = predictPose(motion, mass, motion.velocity, motion.angularMomentum,
                                          settings.orientation, dt);
    const AppliedForce& force = scratch.forces[body];
    if (!force.torque.isZero(0.0)) {
        scratch.fallPose[body] =
            predictPose(motion, mass, motion.velocity + dt * force.acceleration,
                        motion.angularMomentum + dt * force.torque, settings.orientation, dt);
        return;
    }
    // Without a torque the fall differs from the drift by its displacement alone.
    scratch.fallPose[body].orientation = scratch.driftPose[body].orientation;
    scratch.fallPose[body].position =
        motion.position + dt * (motion.velocity + dt * force.acceleration);
}

}  // namespace scree
