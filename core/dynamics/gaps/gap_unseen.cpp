// Symbols: gap_rows.h.
#include "core/dynamics/gaps/gap_unseen.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_lag.h"
#include "core/dynamics/gaps/gap_pace.h"
#include "core/dynamics/gaps/gap_search.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// An overlap that must not come unseen, as a share of the smaller body, nor more than a share of
/// what is thin in the two: edges that are in deeper are none that touch (deepestEdges). With a
/// fifth of it one step in six of a thousand rings is solved again, for overlaps that nobody sees.
constexpr double kVisible = 5e-3, kOfThickness = 0.1;

double visibleOf(const Shape& shape)
{
    if (shape.isPlane) return Shape::kEndless;
    return std::min(kVisible * shape.boundingRadius, kOfThickness * shape.thickness());
}

double visibleTo(const World& world, BodyPair bodies)
{
    return std::min(visibleOf(world.shapeOf(bodies.a)), visibleOf(world.shapeOf(bodies.b)));
}

/// To whom it matters most.
double visibleToAnybody(const World& world)
{
    double least = Shape::kEndless;
    for (std::size_t i = 0; i < world.bodyCount(); ++i)
        least = std::min(least, visibleOf(world.shapeOf(static_cast<BodyId>(i))));
    return least;
}

/// By how much the velocity of any point of a movable body has changed, as solved, beyond what
/// pulls it [m/s].
double changeOf(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    const GapBody& b = scratch.bodies[body];
    const BodyMotion& motion = world.motion[body];
    const Vec3 spin = b.inverseInertia * motion.angularMomentum;
    return (b.velocity - motion.velocity - dt * b.pull).norm() +
           (b.spin - spin - dt * (b.inverseInertia * b.torque)).norm() *
               world.shapeOf(body).boundingRadius;
}

/// How a body moves in the step, as solved.
RigidMotion motionAsSolved(const GapBody& body, double dt)
{
    return {dt * body.velocity + body.shift, dt * body.spin + body.turn};
}

/// As solved, do the bodies run visibly into each other where they have not been looked at: at gaps
/// above `seen`? None is below `least`, but where that is exact, as of balls, by rounding [m].
bool runsIntoUnseen(const World& world, const GapScratch& scratch, BodyPair bodies, double dt,
                    double seen, double least, NearFeatures& near)
{
    const auto [a, b] = bodies;
    const double visible = visibleTo(world, bodies);
    const GapBody &bodyA = scratch.bodies[a], &bodyB = scratch.bodies[b];
    const double within =
        farthestApproach(world, bodies, motionAsSolved(bodyA, dt), motionAsSolved(bodyB, dt)) -
        visible;
    if (within <= std::max(seen, least)) return false;
    thread_local std::vector<GapContact> contacts;
    contacts.clear();
    near.findContacts(placePair(world, bodies), within, contacts);
    const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
    return std::any_of(contacts.begin(), contacts.end(), [&](const GapContact& contact) {
        if (contact.gap < seen) return false;
        GapRow row{};
        placeRow(bodies, contact, bFromA, row);
        const double opened =
            shiftAt(row, bodyA, bodyB) + dt * velocityAt(row, bodyA, bodyB).dot(row.normal);
        return row.gap + opened < -visible;
    });
}

bool isAny(const std::vector<char>& flags)
{
    return std::ranges::find(flags, 1) != flags.end();
}

/// Finds how far the step, as solved, takes bodies from where they were looked for. Answers whether
/// anybody goes as far as `visible`.
bool findStrays(const World& world, double dt, double visible, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    unseen.change.assign(world.bodyCount(), 0.0);
    unseen.strays.assign(world.bodyCount(), 0.0);
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        if (!scratch.bodies[i].isMovable()) return;
        unseen.change[i] = changeOf(world, scratch, body, dt);
        unseen.strays[i] = dt * std::max(unseen.change[i] - scratch.gain[i], 0.0);
    });
    return std::ranges::any_of(unseen.strays, [&](double way) { return way > visible; });
}

/// Whether either ends so far from where it was looked for that it matters to the other.
bool endElsewhere(const World& world, const GapScratch& scratch, BodyPair bodies)
{
    const std::vector<double>& ofBody = scratch.unseen.strays;
    return std::max(ofBody[bodies.a], ofBody[bodies.b]) > visibleTo(world, bodies);
}

/// Marks who leaves the box that it was looked for in, and makes boxes that nobody leaves. Answers
/// whether there is anybody. Whom it would meet there, and how small that is, is not known yet.
bool findFaster(const World& world, double dt, double visible, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    unseen.isFaster.assign(world.bodyCount(), 0);
    unseen.boxes = scratch.boxes;
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        if (!scratch.bodies[i].isMovable()) return;
        const double gained = paceOf(world, scratch, body, dt).fastest(dt) -
                              scratch.paces[i].fastest(dt) - scratch.gain[i];
        unseen.isFaster[i] = dt * gained > visible;
        if (unseen.isFaster[i]) unseen.boxes[i] = unseen.boxes[i].grown(dt * gained);
    });
    return isAny(unseen.isFaster);
}

bool isSolvedAnew(const GapScratch& scratch, BodyPair bodies)
{
    return scratch.isSolvedAnew[bodies.a] || scratch.isSolvedAnew[bodies.b];
}

/// Adds the near pairs that run visibly into each other at gaps they were not looked at for.
void findUnseenAmongNear(const World& world, double dt, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    std::vector<NearPair>& near = scratch.nearPairs;
    unseen.isMet.assign(near.size(), 0);
    forEach(near.size(), kShortWork, [&](std::size_t i) {
        NearPair& pair = near[i];
        if (!isSolvedAnew(scratch, pair.bodies) || !endElsewhere(world, scratch, pair.bodies))
            return;
        const double least = apartAtLeast(world, scratch, pair);
        unseen.isMet[i] =
            runsIntoUnseen(world, scratch, pair.bodies, dt, pair.foundWithin, least, pair.features);
    });
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (unseen.isMet[i]) unseen.pairs.push_back(near[i].bodies);
    }
}

Pose poseAfter(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    const BodyMotion& motion = world.motion[body];
    const RigidMotion solved = motionAsSolved(scratch.bodies[body], dt);
    return {motion.position + solved.shift, rotated(motion.orientation, solved.turn)};
}

/// Adds the pairs that were let pass on their ways as these were, and overlap where the step, as
/// solved, takes them: marbles that pass each other on a stair, of which it throws one up.
void findDiverted(const World& world, double dt, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    unseen.isMet.assign(scratch.pairs.size(), 0);
    forPairs(scratch, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        const auto [a, b] = pair.bodies;
        if (!pair.isLetPass || !isSolvedAnew(scratch, pair.bodies)) return;
        if (!endElsewhere(world, scratch, pair.bodies)) return;
        const PlacedPair placed{&world.shapeOf(a), &world.shapeOf(b),
                                poseAfter(world, scratch, a, dt), poseAfter(world, scratch, b, dt)};
        thread_local std::vector<GapContact> contacts;
        contacts.clear();
        scratch.nearPairs[pair.nearPair].features.findContacts(placed, 0.0, contacts);
        unseen.isMet[i] = deepestOf(contacts) > visibleTo(world, pair.bodies);
    });
    for (std::size_t i = 0; i < scratch.pairs.size(); ++i) {
        if (!unseen.isMet[i]) continue;
        unseen.pairs.push_back(scratch.pairs[i].bodies);
        unseen.diverted.push_back(scratch.pairs[i].bodies);
    }
    std::ranges::sort(unseen.diverted);
}

/// Adds those of others, of whom one leaves its box.
void findUnseenBeyondBoxes(const World& world, double dt, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    const std::vector<BodyPair>& found = scratch.broadPhase.findPairs(
        unseen.boxes, world.mass,
        [&](BodyPair pair) {
            return isMovedPair(world, scratch, pair) && isSolvedAnew(scratch, pair);
        },
        unseen.isFaster);
    unseen.isMet.assign(found.size(), 0);
    forEach(found.size(), 4, [&](std::size_t i) {
        if (std::ranges::binary_search(scratch.nearPairs, found[i], {}, &NearPair::bodies)) return;
        NearFeatures ofNone;
        unseen.isMet[i] = runsIntoUnseen(world, scratch, found[i], dt, 0.0, 0.0, ofNone);
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (unseen.isMet[i]) unseen.pairs.push_back(found[i]);
    }
}

}  // namespace

bool lookFartherWhereUnseen(const World& world, double dt, GapScratch& scratch)
{
    GapUnseen& unseen = scratch.unseen;
    unseen.pairs.clear();
    const double visible = visibleToAnybody(world);
    if (findStrays(world, dt, visible, scratch)) {
        findUnseenAmongNear(world, dt, scratch);
        findDiverted(world, dt, scratch);
        if (findFaster(world, dt, visible, scratch)) findUnseenBeyondBoxes(world, dt, scratch);
    }
    scratch.isSolvedAnew.assign(world.bodyCount(), 0);
    for (const BodyPair& pair : unseen.pairs) {
        for (const BodyId body : {pair.a, pair.b}) {
            scratch.gain[body] = std::max(scratch.gain[body], unseen.change[body]);
            scratch.looksFar[body] = 1;
        }
    }
    return !unseen.pairs.empty();
}

}  // namespace scree
