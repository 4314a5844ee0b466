#include "core/dynamics/scratch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/integrator.h"
#include "core/dynamics/rolling_friction.h"

namespace scree {
namespace {

/// Everything the body may touch while it moves on freely for `time`.
Aabb sweptBox(const World& world, BodyId body, const StepSettings& settings, double time)
{
    const Shape& shape = world.shapeOf(body);
    const BodyMotion& motion = world.motion[body];
    if (!world.isBorn(body)) return {};  // an empty box meets nothing
    Aabb box = boxAt(shape, motion.worldFromBody());
    if (!world.mass[body].isMovable()) return box;

    const double turn = angularVelocity(motion, world.mass[body]).norm() * time;
    const Vec3 radius = Vec3::Constant(shape.boundingRadius);
    const Aabb sphere{motion.position - radius, motion.position + radius};
    box = box.grown(std::min(turn, 2.0) * shape.boundingRadius);
    box = {box.min.cwiseMax(sphere.min), box.max.cwiseMin(sphere.max)};

    // The path is a parabola between drift and fall: a box around both ends holds it.
    const Vec3 drift = time * motion.velocity;
    const Vec3 fall = drift + time * time * settings.gravity;
    Aabb swept = box;
    swept.include(Aabb{box.min + drift, box.max + drift});
    swept.include(Aabb{box.min + fall, box.max + fall});
    return swept.grown(contourValue(shape, shape));
}

void describePair(const World& world, BodyPair bodies, PairRecord& record)
{
    const Material& a = world.materialOf(bodies.a);
    const Material& b = world.materialOf(bodies.b);
    record.bodies = bodies;
    record.tau = contourValue(world.shapeOf(bodies.a), world.shapeOf(bodies.b));
    record.friction = std::max(a.friction, b.friction);  // [A27]
    record.restitution = std::min(a.restitution, b.restitution);
    record.rolling = largerOf(a.rolling, b.rolling);
    record.interferesNow = record.isTouched = false;
    record.aFallsOnB = record.bFallsOnA = record.aLeavesB = record.bLeavesA = false;
}

double speedOfSurface(const World& world, BodyId body)
{
    if (!world.mass[body].isMovable()) return 0.0;
    return angularVelocity(world.motion[body], world.mass[body]).norm() *
           world.shapeOf(body).boundingRadius;
}

/// How far a pair may move before it looks for near samples again: a little more than it will move
/// if nothing happens. Only a matter of speed.
double lookMargin(const World& world, const StepSettings& settings, BodyPair bodies, double dt)
{
    const double speed =
        (world.motion[bodies.a].velocity - world.motion[bodies.b].velocity).norm() +
        speedOfSurface(world, bodies.a) + speedOfSurface(world, bodies.b);
    const auto thickness = [&](BodyId body) {
        const Shape& shape = world.shapeOf(body);
        return shape.isPlane ? std::numeric_limits<double>::infinity() : shape.innerThickness;
    };
    const double thinner = std::min(thickness(bodies.a), thickness(bodies.b));
    return std::max(1e-3 * thinner, 2.0 * dt * (speed + dt * settings.gravity.norm()));
}

}  // namespace

Aabb boxAt(const Shape& shape, const Pose& pose)
{
    if (shape.isPlane) return shape.box;
    return transformed(shape.box, pose.orientation.toRotationMatrix(), pose.position);
}

void findPairs(const World& world, const StepSettings& settings, double remaining,
               StepScratch& scratch)
{
    const std::size_t bodies = world.bodyCount();
    scratch.sweptBoxes.resize(bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
        scratch.sweptBoxes[b] = sweptBox(world, static_cast<BodyId>(b), settings, remaining);
    }
    const auto& found = scratch.broadPhase.findPairs(scratch.sweptBoxes, world.mass);
    scratch.pairCount = found.size();
    if (scratch.pairs.size() < found.size()) scratch.pairs.resize(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) describePair(world, found[i], scratch.pairs[i]);
}

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

void beginStep(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    const std::size_t bodies = world.bodyCount();
    scratch.inertia.resize(bodies);
    scratch.fallPose.resize(bodies);
    scratch.driftPose.resize(bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
        scratch.inertia[b] = passInertia(world.mass[b], world.motion[b].orientation);
        scratch.driftPose[b] = scratch.fallPose[b] = world.motion[b].worldFromBody();
        predictBody(world, settings, dt, static_cast<BodyId>(b), scratch);
    }
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        PairRecord& pair = scratch.pairs[i];
        pair.proximity.reset(lookMargin(world, settings, pair.bodies, dt));
    }
    sortPairs(world, scratch);
}

void widenPairs(const World& world, const StepSettings& settings, double dt, StepScratch& scratch)
{
    bool isWider = false;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const auto body = static_cast<BodyId>(b);
        if (!world.mass[b].isMovable()) continue;
        const Shape& shape = world.shapeOf(body);
        Aabb reached = boxAt(shape, scratch.fallPose[b]);
        reached.include(boxAt(shape, scratch.driftPose[b]));
        if (scratch.sweptBoxes[b].contains(reached)) continue;
        scratch.sweptBoxes[b].include(sweptBox(world, body, settings, 2.0 * dt));
        isWider = true;
    }
    if (!isWider) return;

    // Old and new list are both sorted and the new one contains the old one.
    const auto& found = scratch.broadPhase.findPairs(scratch.sweptBoxes, world.mass);
    std::vector<PairRecord> wider(std::max(found.size(), scratch.pairs.size()));
    std::size_t old = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (old < scratch.pairCount && scratch.pairs[old].bodies == found[i]) {
            wider[i] = std::move(scratch.pairs[old++]);
        } else {
            describePair(world, found[i], wider[i]);
            wider[i].proximity.reset(lookMargin(world, settings, found[i], dt));
        }
    }
    scratch.pairs = std::move(wider);
    scratch.pairCount = found.size();
    sortPairs(world, scratch);
}

void predictBody(const World& world, const StepSettings& settings, double dt, BodyId body,
                 StepScratch& scratch)
{
    const BodyMotion& motion = world.motion[body];
    const BodyMass& mass = world.mass[body];
    if (!mass.isMovable()) return;
    scratch.driftPose[body] = predictPose(motion, mass, motion.velocity, motion.angularMomentum,
                                          settings.orientation, dt);
    // Gravity turns nothing: the fall differs from the drift by its displacement alone.
    scratch.fallPose[body].orientation = scratch.driftPose[body].orientation;
    scratch.fallPose[body].position =
        motion.position + dt * (motion.velocity + dt * settings.gravity);
}

}  // namespace scree
