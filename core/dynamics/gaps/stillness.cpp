#include "core/dynamics/gaps/stillness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// A body that stays within this share of its size of one place is still: an eighth of a millimetre
/// on a ring of 2.5 m. A domino at the point of falling passes it within a few frames.
constexpr double kStill = 1e-4;
/// For so long, in units of time: half a second for that ring. Small things, which must lie still
/// for as many frames, may come so many times as far: a cone of 8 cm whose centre of mass lay a
/// third of a micrometre beside its axis rolled on at 13 µm/s, and never slept.
constexpr double kStillTime = 1.4;

/// What has stayed within this share of its size of one place may rock, but goes nowhere.
constexpr double kNearby = 0.05;
/// The same of what rocks as wide as a bowl does on its round bottom, or as a can does around the
/// rim of its own.
constexpr double kAround = 0.4;

/// So many times as long as it takes to fall asleep this share of an island must have stayed nearby
/// before the island is said to settle.
constexpr double kSettlingTime = 3.0, kSettlingShare = 0.9;

/// What goes farther than this share of its size in a frame does not lie where it is seen at the
/// end of each: it may have turned once around.
constexpr double kFarInAFrame = 0.5;

/// A force has changed when it has by this share. What wind takes from the last creep of a body is
/// none: a house of cards in still air slept for a frame and was woken in the next, again and
/// again.
constexpr double kUnnoticed = 1e-3;

/// Upper bound of how far a point of the body has come from where it was [m].
double travelled(const World& world, BodyId body, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double turned = chordOfTurn(since.orientation, motion.orientation);
    return (motion.position - since.position).norm() + turned * world.shapeOf(body).boundingRadius;
}

/// The same of what one sees of it.
double travelledInSight(const World& world, BodyId body, const Stay& since)
{
    const double turned = shownTurn(world, body, since.orientation).norm();
    return (world.motion[body].position - since.position).norm() +
           turned * world.shapeOf(body).boundingRadius;
}

bool goesFarInAFrame(const World& world, BodyId body)
{
    const BodyMotion& motion = world.motion[body];
    const double radius = world.shapeOf(body).boundingRadius;
    const Vec3 spin = angularVelocity(motion, world.mass[body]);
    const double speed = motion.velocity.norm() + spin.norm() * radius;
    return speed * world.frameDuration > kFarInAFrame * radius;
}

double stillShare(const World& world, BodyId body, const AppliedForce& force)
{
    const double unit = unitOfTime(world, body, force.acceleration.norm());
    return kStill * std::max(kStillFrames * world.frameDuration / (kStillTime * unit), 1.0);
}

/// One more frame within `share` of its size of the place, of which it is `way` away, or a new
/// place.
void noteStay(const World& world, BodyId body, double share, double way, Stay& stay)
{
    const double allowed = share * world.shapeOf(body).boundingRadius;
    const bool isSeen = stay.frames >= 0;
    if (isSeen && way <= allowed && !goesFarInAFrame(world, body)) {
        ++stay.frames;
    } else {
        stay = {world.motion[body].position, world.motion[body].orientation, 0};
    }
}

}  // namespace

Vec3 shownTurn(const World& world, BodyId body, const Quat& since)
{
    const Shape& shape = world.shapeOf(body);
    const Quat& now = world.motion[body].orientation;
    if (shape.turnsThatShow.isZero(0.0)) return Vec3::Zero();
    if (shape.turnsThatShow.sum() != 2.0) return rotationVector(now * since.conjugate());
    const Vec3 axis = Vec3::Ones() - shape.turnsThatShow;
    return rotationVector(Quat::FromTwoVectors(since * axis, now * axis));
}

double unitOfTime(const World& world, BodyId body, double acceleration)
{
    return std::sqrt(world.shapeOf(body).boundingRadius / acceleration);
}

double framesToSleep(const World& world, BodyId body, double acceleration)
{
    const double time = kStillTime * unitOfTime(world, body, acceleration);
    return std::max(std::ceil(time / world.frameDuration), double{kStillFrames});
}

double unitsAround(const World& world, const GapScratch& scratch, BodyId body)
{
    const GapBody& seen = scratch.bodies[body];
    if (isDriven(seen)) return 0.0;
    if (!seen.isMovable()) return std::numeric_limits<double>::infinity();
    if (world.contactMemory.rest.size() < world.bodyCount()) return 0.0;
    return world.contactMemory.rest[body].around.frames * world.frameDuration /
           unitOfTime(world, body, seen.pull.norm());
}

bool isSettling(const World& world, const GapScratch& scratch, const GapIsland& island)
{
    if (world.contactMemory.rest.size() < world.bodyCount()) return false;  // nobody sleeps
    const auto staying = std::ranges::count_if(island.movers, [&](BodyId body) {
        const double frames = framesToSleep(world, body, scratch.bodies[body].pull.norm());
        return world.contactMemory.rest[body].nearby.frames >= kSettlingTime * frames ||
               unitsAround(world, scratch, body) >= kLongAround;
    });
    return static_cast<double>(staying) >=
           kSettlingShare * static_cast<double>(island.movers.size());
}

bool isPulledAsBefore(const BodyRest& rest, const AppliedForce& now)
{
    return (rest.pull - now.acceleration).norm() <= kUnnoticed * rest.pull.norm();
}

void noteStays(World& world, const std::vector<AppliedForce>& forces)
{
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        BodyRest& rest = world.contactMemory.rest[i];
        if (rest.isAsleep) continue;
        if (!world.isStepped(body)) {
            // What a script let go of was calmed for having been about before it was taken.
            rest.still = rest.nearby = rest.around = Stay{};
            continue;
        }
        noteStay(world, body, stillShare(world, body, forces[i]),
                 travelled(world, body, rest.still), rest.still);
        noteStay(world, body, kNearby, travelled(world, body, rest.nearby), rest.nearby);
        noteStay(world, body, kAround, travelledInSight(world, body, rest.around), rest.around);
    }
}

}  // namespace scree
