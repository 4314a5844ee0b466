#include "core/dynamics/gaps/calming.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/dynamics/gaps/stillness.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What has stayed nearby for so long loses its motion by and by, 1/e of it in kCalmTime; both in
/// units of time, a third of a second for a ring of 2.5 m, so that a tower takes as long to fall as
/// it should.
constexpr double kCalmWait = 6.0, kCalmTime = 1.0;

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

/// Whether a body moves away from where it was, and is faster than at the beginning of the step.
/// What rocks about that place gets slower on its way from it; what begins to slide or to fall does
/// not. Calmed like the others, a box that a growing push set in motion after seconds of rest went
/// half as fast as it should for the first tenth of its length.
bool setsOut(const World& world, const GapScratch& scratch, BodyId body, const Stay& since)
{
    const Course course = courseOf(world, body, since);
    const GapBody& before = scratch.bodies[body];
    const double radius = world.shapeOf(body).boundingRadius;
    return course.along > 0.0 &&
           course.square > before.velocityBefore.squaredNorm() +
                               radius * radius * before.spinBefore.squaredNorm();
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

/// Whether a body has stayed for a time, in units of its own.
bool hasStayed(const World& world, const Stay& stay, double wait, double unit)
{
    return stay.frames * world.frameDuration >= wait * unit;
}

/// Whether a body has been where it is for long enough to be calmed in one way or the other.
bool hasStayedForLong(const World& world, const GapScratch& scratch, BodyId body)
{
    const double acceleration = scratch.forces[body].acceleration.norm();
    if (acceleration == 0.0 || !world.isStepped(body)) return false;
    const BodyRest& rest = world.contactMemory.rest[body];
    const double unit = unitOfTime(world, body, acceleration);
    return hasStayed(world, rest.nearby, kCalmWait, unit) ||
           hasStayed(world, rest.around, kLongWait, unit);
}

/// What it loses in a step.
void calm(World& world, const GapScratch& scratch, BodyId body, bool hangs, double dt)
{
    const BodyRest& rest = world.contactMemory.rest[body];
    const double unit = unitOfTime(world, body, scratch.forces[body].acceleration.norm());
    BodyMotion& motion = world.motion[body];
    const auto take = [&](double time, const Vec3& angularMomentum) {
        const double lost = 1.0 - 1.0 / (1.0 + dt / time);
        motion.velocity -= lost * motion.velocity;
        motion.angularMomentum -= lost * angularMomentum;
    };
    if (hasStayed(world, rest.nearby, kCalmWait, unit) &&
        !goesOn(world, body, kCalmWait * unit, rest.nearby) &&
        !setsOut(world, scratch, body, rest.nearby))
        take(kCalmTime * unit, motion.angularMomentum);
    else if (!hangs && hasStayed(world, rest.around, kLongWait, unit) &&
             comesBack(world, body, rest.around))
        take(kLongTime * unit,
             world.shapeOf(body).shownOf(motion.angularMomentum, motion.orientation));
}

/// How a body is held up by others.
struct Carriage {
    bool isCarried = false;
    double hanging = 0.0;  ///< sum of what holds it times how far above its centre that is
};

/// Of those that stay, by their flags.
std::vector<Carriage> carriages(const std::vector<char>& stays, const GapScratch& scratch)
{
    std::vector<Carriage> carried(stays.size());
    const auto carry = [&](BodyId body, const Vec3& r, const Vec3& impulse) {
        if (!stays[body]) return;
        const Vec3& pull = scratch.forces[body].acceleration;
        carried[body].isCarried = true;
        carried[body].hanging += impulse.dot(pull) * r.dot(pull);
    };
    for (const GapRow& row : scratch.rows) {
        if (!row.carries() || (!stays[row.a] && !stays[row.b])) continue;
        const Vec3 impulse = row.worldImpulse();
        carry(row.a, row.rA, impulse);
        carry(row.b, row.rB, -impulse);
    }
    return carried;
}

/// Per body, whether a script moves it or anything that it hangs together with; empty where a
/// script moves nothing.
std::vector<char> whoIsDriven(const World& world, const GapScratch& scratch)
{
    std::vector<char> isDrivenToo;
    if (std::ranges::none_of(scratch.bodies, isDriven)) return isDrivenToo;
    DisjointSets sets(world.bodyCount());
    std::vector<char> isDrivenSet(world.bodyCount(), 0);
    for (const GapRow& row : scratch.rows) {
        if (row.carries() && world.isStepped(row.a) && world.isStepped(row.b))
            sets.join(static_cast<std::size_t>(row.a), static_cast<std::size_t>(row.b));
    }
    for (const GapRow& row : scratch.rows) {
        if (!row.carries()) continue;
        for (const auto& [carrier, other] : {std::pair{row.a, row.b}, std::pair{row.b, row.a}}) {
            if (isDriven(scratch.bodies[carrier]))
                isDrivenSet[sets.find(static_cast<std::size_t>(other))] = 1;
        }
    }
    isDrivenToo.resize(world.bodyCount());
    for (std::size_t i = 0; i < isDrivenToo.size(); ++i) isDrivenToo[i] = isDrivenSet[sets.find(i)];
    return isDrivenToo;
}

}  // namespace

void calmWhatRocks(World& world, double dt, const GapScratch& scratch)
{
    if (world.contactMemory.rest.empty()) return;  // no frame has ended yet
    std::vector<char> stays(world.bodyCount(), 0);
    for (std::size_t i = 0; i < world.contactMemory.rest.size(); ++i)
        stays[i] = hasStayedForLong(world, scratch, static_cast<BodyId>(i));
    if (std::ranges::find(stays, 1) == stays.end()) return;
    const std::vector<Carriage> carried = carriages(stays, scratch);
    const std::vector<char> driven = whoIsDriven(world, scratch);
    for (std::size_t i = 0; i < stays.size(); ++i) {
        if (!carried[i].isCarried || (!driven.empty() && driven[i])) continue;
        calm(world, scratch, static_cast<BodyId>(i), carried[i].hanging > 0.0, dt);
    }
}

}  // namespace scree
