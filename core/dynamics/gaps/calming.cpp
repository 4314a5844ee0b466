#include "core/dynamics/gaps/calming.h"

#include <cmath>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/dynamics/gaps/stillness.h"
#include "core/dynamics/integrator.h"
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

/// What rocks wider, a bowl on its round bottom or a plank on a ball, is let do so for this time,
/// and then loses 1/e of its motion in that on its ways back: of two hundred odds and ends three
/// bowls rocked on for as long as anybody looked. What falls over does not come back, and what
/// hangs may swing. What circles on its rim turns about its own axis as well, and may go on to:
/// a screw on its head kept a heap of four hundred awake for eight seconds.
constexpr double kLongWait = 18.0, kLongTime = 4.0;

/// How a body moves against the way it has come since, both as far as a point of it may.
struct Course {
    double along;   ///< way times speed: negative where it comes back [m²/s]
    double square;  ///< of the speed [m²/s²]
};

Course courseOf(const World& world, BodyId body, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double radius = world.shapeOf(body).boundingRadius;
    const Vec3 way = motion.position - since.position;
    const Vec3 turn = radius * rotationVector(motion.orientation * since.orientation.conjugate());
    const Vec3 speedOfTurn = radius * angularVelocity(motion, world.mass[body]);
    return {way.dot(motion.velocity) + turn.dot(speedOfTurn),
            motion.velocity.squaredNorm() + speedOfTurn.squaredNorm()};
}

/// Whether a body moves on from where it was, and has for as long as `time`.
bool goesOn(const World& world, BodyId body, double time, const Stay& since)
{
    const Course course = courseOf(world, body, since);
    const double radius = world.shapeOf(body).boundingRadius;
    return time * std::sqrt(course.square) >= kCreeps * radius &&
           course.along >= kGoesOn * time * course.square;
}

/// Whether a body, as one sees it, moves back to where it was.
bool comesBack(const World& world, BodyId body, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const Shape& shape = world.shapeOf(body);
    const Vec3 way = motion.position - since.position;
    const Vec3 turn = shape.boundingRadius * shownTurn(world, body, since.orientation);
    const Vec3 spin = shape.shownOf(angularVelocity(motion, world.mass[body]), motion.orientation);
    return way.dot(motion.velocity) + shape.boundingRadius * turn.dot(spin) < 0.0;
}

void calm(World& world, BodyId body, double acceleration, bool hangs)
{
    if (acceleration == 0.0) return;
    const BodyRest& rest = world.contactMemory.rest[body];
    const double unit = unitOfTime(world, body, acceleration);
    const auto hasStayed = [&](const Stay& stay, double wait) {
        return stay.frames * world.frameDuration >= wait * unit;
    };
    BodyMotion& motion = world.motion[body];
    const auto take = [&](double time, const Vec3& angularMomentum) {
        const double lost = 1.0 - 1.0 / (1.0 + world.frameDuration / time);
        motion.velocity -= lost * motion.velocity;
        motion.angularMomentum -= lost * angularMomentum;
    };
    if (hasStayed(rest.nearby, kCalmWait) && !goesOn(world, body, kCalmWait * unit, rest.nearby))
        take(kCalmTime * unit, motion.angularMomentum);
    else if (!hangs && hasStayed(rest.around, kLongWait) && comesBack(world, body, rest.around))
        take(kLongTime * unit,
             world.shapeOf(body).shownOf(motion.angularMomentum, motion.orientation));
}

/// How a body is held up by others.
struct Carriage {
    bool mayBeCalmed = false;  ///< it is stepped, others hold it, and no script moves any of these
    double hanging = 0.0;      ///< sum of what holds it times how far above its centre that is
};

std::vector<Carriage> carriages(const World& world, const GapScratch& scratch)
{
    DisjointSets sets(world.bodyCount());
    std::vector<Carriage> carried(world.bodyCount());
    std::vector<char> isDrivenSet(world.bodyCount(), 0);
    const auto carry = [&](BodyId body, const Vec3& r, const Vec3& impulse) {
        const Vec3& pull = scratch.forces[body].acceleration;
        carried[body].mayBeCalmed = world.isStepped(body);
        carried[body].hanging += impulse.dot(pull) * r.dot(pull);
    };
    for (const GapRow& row : scratch.rows) {
        if (!row.carries()) continue;
        const Vec3 impulse = row.worldImpulse();
        carry(row.a, row.rA, impulse);
        carry(row.b, row.rB, -impulse);
        if (world.isStepped(row.a) && world.isStepped(row.b))
            sets.join(static_cast<std::size_t>(row.a), static_cast<std::size_t>(row.b));
    }
    for (const GapRow& row : scratch.rows) {
        if (!row.carries()) continue;
        for (const auto& [carrier, other] : {std::pair{row.a, row.b}, std::pair{row.b, row.a}}) {
            if (isDriven(scratch.bodies[carrier]))
                isDrivenSet[sets.find(static_cast<std::size_t>(other))] = 1;
        }
    }
    for (std::size_t i = 0; i < carried.size(); ++i)
        carried[i].mayBeCalmed = carried[i].mayBeCalmed && !isDrivenSet[sets.find(i)];
    return carried;
}

}  // namespace

void calmWhatRocks(World& world, const GapScratch& scratch)
{
    const std::vector<Carriage> carried = carriages(world, scratch);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const double acceleration = scratch.forces[i].acceleration.norm();
        if (carried[i].mayBeCalmed)
            calm(world, static_cast<BodyId>(i), acceleration, carried[i].hanging > 0.0);
    }
}

}  // namespace scree
