// Symbols: gap_rows.h.
#include "core/dynamics/gap_unseen.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/gap_lag.h"
#include "core/dynamics/gap_pace.h"
#include "core/dynamics/gap_search.h"

namespace scree {
namespace {

/// An overlap that must not come unseen, as a share of the smaller body.
constexpr double kVisible = 1e-3;

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
RigidMotion motionOf(const GapBody& body, double dt)
{
    return {dt * body.velocity + body.shift, dt * body.spin + body.turn};
}

/// As solved, do the bodies run visibly into each other where they have not been looked at: at gaps
/// above `seen` [m]?
bool runsIntoUnseen(const World& world, const GapScratch& scratch, BodyPair bodies, double dt,
                    double seen, NearFeatures& near)
{
    const auto [a, b] = bodies;
    const double visible = kVisible * smallerRadius(world, a, b);
    const GapBody &bodyA = scratch.bodies[a], &bodyB = scratch.bodies[b];
    const double within =
        farthestApproach(world, bodies, motionOf(bodyA, dt), motionOf(bodyB, dt)) - visible;
    if (within <= seen) return false;
    std::vector<GapContact> contacts;
    near.findContacts(placePair(world, bodies), within, contacts);
    const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
    return std::any_of(contacts.begin(), contacts.end(), [&](const GapContact& contact) {
        if (contact.gap < seen) return false;
        GapRow row{};
        row.rA = contact.rA;
        row.rB = contact.rA + bFromA;
        row.normal = contact.normal;
        const double opened =
            shiftAt(row, bodyA, bodyB) + dt * velocityAt(row, bodyA, bodyB).dot(row.normal);
        return contact.gap + opened < -visible;
    });
}

/// Whom the step has given another velocity than it was looked for with, so that it ends visibly
/// elsewhere.
struct Struck {
    std::vector<double> change;  ///< per body [m/s]
    std::vector<char> isStruck;
    bool isAny = false;
};

Struck findStruck(const World& world, const GapScratch& scratch, double dt)
{
    Struck struck{std::vector<double>(world.bodyCount(), 0.0),
                  std::vector<char>(world.bodyCount(), 0)};
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        if (scratch.bodies[i].inverseMass == 0.0) return;
        const double visible = kVisible * world.shapeOf(body).boundingRadius;
        struck.change[i] = changeOf(world, scratch, body, dt);
        struck.isStruck[i] = dt * (struck.change[i] - scratch.gain[i]) > visible;
    });
    struck.isAny = std::ranges::find(struck.isStruck, 1) != struck.isStruck.end();
    return struck;
}

/// Who leaves the box that it was looked for in, and the boxes that nobody leaves.
struct Faster {
    std::vector<char> isFaster;
    std::vector<Aabb> boxes;
    bool isAny = false;
};

Faster findFaster(const World& world, const GapScratch& scratch, double dt)
{
    Faster faster{std::vector<char>(world.bodyCount(), 0), scratch.boxes};
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        if (scratch.bodies[i].inverseMass == 0.0) return;
        const double gained = paceOf(world, scratch, body, dt).fastest(dt) -
                              scratch.paces[i].fastest(dt) - scratch.gain[i];
        faster.isFaster[i] = dt * gained > kVisible * world.shapeOf(body).boundingRadius;
        if (faster.isFaster[i]) faster.boxes[i] = faster.boxes[i].grown(dt * gained);
    });
    faster.isAny = std::ranges::find(faster.isFaster, 1) != faster.isFaster.end();
    return faster;
}

bool isSolvedAnew(const GapScratch& scratch, BodyPair bodies)
{
    return scratch.isSolvedAnew[bodies.a] || scratch.isSolvedAnew[bodies.b];
}

/// Those that run visibly into what they were not looked at for.
std::vector<BodyPair> findUnseen(const World& world, const Struck& struck, double dt,
                                 GapScratch& scratch)
{
    std::vector<BodyPair> unseen;
    if (!struck.isAny) return unseen;

    std::vector<NearPair>& known = scratch.nearPairs;
    std::vector<char> isMet(known.size(), 0);
    forEach(known.size(), kShortWork, [&](std::size_t i) {
        NearPair& pair = known[i];
        if (!struck.isStruck[pair.bodies.a] && !struck.isStruck[pair.bodies.b]) return;
        if (!isSolvedAnew(scratch, pair.bodies)) return;
        const double seen =
            std::max(pair.foundWithin, pair.farUntil - odometerOf(scratch, pair.bodies));
        isMet[i] = runsIntoUnseen(world, scratch, pair.bodies, dt, seen, pair.near);
    });
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (isMet[i]) unseen.push_back(known[i].bodies);
    }

    const Faster faster = findFaster(world, scratch, dt);
    if (!faster.isAny) return unseen;
    const std::vector<BodyPair>& pairs = scratch.broadPhase.findPairs(
        faster.boxes, world.mass,
        [&](BodyPair pair) {
            return isMovedPair(world, scratch, pair) && isSolvedAnew(scratch, pair);
        },
        faster.isFaster);
    isMet.assign(pairs.size(), 0);
    forEach(pairs.size(), 4, [&](std::size_t i) {
        if (std::ranges::binary_search(known, pairs[i], {}, &NearPair::bodies)) return;
        NearFeatures ofNone;
        isMet[i] = runsIntoUnseen(world, scratch, pairs[i], dt, 0.0, ofNone);
    });
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (isMet[i]) unseen.push_back(pairs[i]);
    }
    return unseen;
}

}  // namespace

bool meetsUnseen(const World& world, double dt, GapScratch& scratch)
{
    const Struck struck = findStruck(world, scratch, dt);
    const std::vector<BodyPair> unseen = findUnseen(world, struck, dt, scratch);
    scratch.isSolvedAnew.assign(world.bodyCount(), 0);
    for (const BodyPair& pair : unseen) {
        for (const BodyId body : {pair.a, pair.b}) {
            scratch.gain[body] = std::max(scratch.gain[body], struck.change[body]);
            scratch.looksFar[body] = 1;
        }
    }
    return !unseen.empty();
}

}  // namespace scree
