#include "core/dynamics/candidates.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/collision/interference.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/impulse.h"

namespace scree {
namespace {

/// However far a body turns, no point comes farther than across the circle it is on, in radii.
constexpr double kLongestChord = 2.0;

/// Everything a keyed body may touch in the next `time`: around the present box, since a script may
/// go anywhere at the speeds it has.
Aabb scriptedBox(const World& world, BodyId body, double time)
{
    const Shape& shape = world.shapeOf(body);
    const BodyMotion& motion = world.motion[body];
    const ScriptBounds bounds =
        world.info[body].script->boundsBetween(world.time(), world.time(time));
    double speed = 0.0;
    for (const Vec3& v : bounds.velocities) speed = std::max(speed, v.norm());
    const double arm = shape.bodyFromAsset.position.norm();
    const double turn = std::min(bounds.spin * time, kLongestChord);
    const double reach = speed * time + turn * (arm + shape.boundingRadius);
    return boxAt(shape, motion.worldFromBody()).grown(reach + contourValue(shape, shape));
}

/// Everything the body may touch while it moves on freely for `time`.
Aabb sweptBox(const World& world, BodyId body, const AppliedForce& force, double time)
{
    if (!world.isBorn(body)) return {};  // an empty box meets nothing
    if (world.info[body].kind == BodyKind::keyed) return scriptedBox(world, body, time);
    const Shape& shape = world.shapeOf(body);
    const BodyMotion& motion = world.motion[body];
    Aabb box = boxAt(shape, motion.worldFromBody());
    if (!world.mass[body].isMovable()) return box;

    const Mat3 inverseInertia = passInertia(world.mass[body], motion.orientation).inverseInertia;
    const double spin = (inverseInertia * motion.angularMomentum).norm() +
                        (inverseInertia * force.torque).norm() * time;
    const double turn = spin * time;
    const Vec3 radius = Vec3::Constant(shape.boundingRadius);
    const Aabb sphere{motion.position - radius, motion.position + radius};
    box = box.grown(std::min(turn, kLongestChord) * shape.boundingRadius);
    box = {box.min.cwiseMax(sphere.min), box.max.cwiseMin(sphere.max)};

    // The path is a parabola between drift and fall: a box around both ends holds it.
    const Vec3 drift = time * motion.velocity;
    const Vec3 fall = drift + time * time * force.acceleration;
    Aabb swept = box;
    swept.include(Aabb{box.min + drift, box.max + drift});
    swept.include(Aabb{box.min + fall, box.max + fall});
    return swept.grown(contourValue(shape, shape));
}

void pairUp(const World& world, Candidates& candidates)
{
    thread_local std::vector<char> isAsked;
    isAsked.resize(world.bodyCount());
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        const auto body = static_cast<BodyId>(b);
        isAsked[b] = world.isStepped(body) || world.info[b].kind == BodyKind::keyed;
    }
    candidates.pairs = candidates.broadPhase.findPairs(
        candidates.sweptBoxes, world.mass, [&](BodyPair pair) { return mayCollide(world, pair); },
        isAsked);
}

}  // namespace

void findCandidates(const World& world, const std::vector<AppliedForce>& forces, double remaining,
                    Candidates& candidates)
{
    candidates.sweptBoxes.resize(world.bodyCount());
    forEach(world.bodyCount(), kShortWork, [&](std::size_t b) {
        candidates.sweptBoxes[b] = sweptBox(world, static_cast<BodyId>(b), forces[b], remaining);
    });
    pairUp(world, candidates);
}

bool widenCandidates(const World& world, const std::vector<AppliedForce>& forces,
                     const std::vector<Aabb>& reached, double time, Candidates& candidates)
{
    bool isWider = false;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable() || candidates.sweptBoxes[b].contains(reached[b])) continue;
        candidates.sweptBoxes[b].include(sweptBox(world, static_cast<BodyId>(b), forces[b], time));
        isWider = true;
    }
    if (isWider) pairUp(world, candidates);
    return isWider;
}

}  // namespace scree
