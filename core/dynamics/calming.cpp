#include "core/dynamics/calming.h"

#include <cmath>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/stillness.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What has stayed nearby for so long loses its motion by and by, 1/e of it in kCalmTime; both in
/// units of time, a third of a second for a ring of 2.5 m, so that a tower takes as long to fall as
/// it should.
constexpr double kCalmWait = 6.0, kCalmTime = 1.5;

/// But not what goes on and on, however slowly: what has come at least this share of what it would
/// have in kCalmWait with the velocity it has. What speeds up evenly from rest has come half of
/// that by then, and what rocks comes back; with a quarter a plank that rocked on a ball took as
/// long again. Calmed like the others, a block on a slope barely steeper than friction holds was
/// 6 cm from its place after 10 s, not half a metre.
constexpr double kGoesOn = 0.45;
/// As long as it goes by this share of its size in that time: cubes that settled by less than that
/// kept a heap of a thousand awake for a second longer.
constexpr double kCreeps = 4e-3;

/// Whether a body moves on from where it was, and has for as long as `time`.
bool goesOn(const World& world, BodyId body, double time, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double radius = world.shapeOf(body).boundingRadius;
    const Vec3 way = motion.position - since.position;
    const Vec3 turn = radius * rotationVector(motion.orientation * since.orientation.conjugate());
    const Vec3 speedOfTurn = radius * angularVelocity(motion, world.mass[body]);
    const double along = way.dot(motion.velocity) + turn.dot(speedOfTurn);
    const double speeds = motion.velocity.squaredNorm() + speedOfTurn.squaredNorm();
    return time * std::sqrt(speeds) >= kCreeps * radius && along >= kGoesOn * time * speeds;
}

void calm(World& world, BodyId body, double acceleration)
{
    if (acceleration == 0.0) return;
    const Stay& nearby = world.contactMemory.rest[body].nearby;
    const double unit = unitOfTime(world, body, acceleration);
    const double wait = kCalmWait * unit;
    if (nearby.frames * world.frameDuration < wait || goesOn(world, body, wait, nearby)) return;
    const double kept = 1.0 / (1.0 + world.frameDuration / (kCalmTime * unit));
    world.motion[body].velocity *= kept;
    world.motion[body].angularMomentum *= kept;
}

/// Per body: whether it is stepped, lies on others, and no script moves any of these, nor what
/// those lie on in turn.
std::vector<char> whoMayBeCalmed(const World& world, const GapScratch& scratch)
{
    DisjointSets sets(world.bodyCount());
    std::vector<char> isCarried(world.bodyCount(), 0), isDrivenSet(world.bodyCount(), 0);
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
        isCarried[a] = isCarried[b] = 1;
        if (world.isStepped(row.a) && world.isStepped(row.b)) sets.join(a, b);
    }
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        for (const auto& [carrier, carried] : {std::pair{row.a, row.b}, std::pair{row.b, row.a}}) {
            if (isDriven(scratch.bodies[carrier]))
                isDrivenSet[sets.find(static_cast<std::size_t>(carried))] = 1;
        }
    }
    std::vector<char> may(world.bodyCount(), 0);
    for (std::size_t i = 0; i < may.size(); ++i)
        may[i] =
            world.isStepped(static_cast<BodyId>(i)) && isCarried[i] && !isDrivenSet[sets.find(i)];
    return may;
}

}  // namespace

void calmWhatRocks(World& world, const GapScratch& scratch)
{
    const std::vector<char> may = whoMayBeCalmed(world, scratch);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (may[i]) calm(world, static_cast<BodyId>(i), scratch.forces[i].acceleration.norm());
    }
}

}  // namespace scree
