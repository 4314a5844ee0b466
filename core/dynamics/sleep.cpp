#include "core/dynamics/sleep.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/collision/broad_phase.h"
#include "core/collision/near_features.h"
#include "core/dynamics/disjoint_sets.h"
#include "core/dynamics/forces.h"

namespace scree {
namespace {

/// A body that stays within this share of its size of one place is still: an eighth of a millimetre
/// on a ring of 2.5 m. A domino at the point of falling passes it within a few frames.
constexpr double kStill = 1e-4;
constexpr std::int32_t kStillFrames = 12;

/// What has stayed within this share of its size of one place for kSettleWait loses its motion by
/// and by, 1/e of it in kSettleTime; both times in √(size / acceleration), a third of a second for
/// that ring, so that a tower takes as long to fall as it should.
constexpr double kNearby = 0.05;
constexpr double kSettleWait = 6.0, kSettleTime = 1.5;

bool isStepped(const World& world, BodyId body)
{
    return world.mass[body].isMovable() && !world.contactMemory.isAsleep(body);
}

/// Upper bound of how far a point of the body has come from where it was.
double travelled(const World& world, BodyId body, const Stay& since)
{
    const BodyMotion& motion = world.motion[body];
    const double turned = 2.0 * (motion.orientation * since.orientation.conjugate()).vec().norm();
    return (motion.position - since.position).norm() + turned * world.shapeOf(body).boundingRadius;
}

/// One more frame within `share` of its size of the place, or a new place.
void goOn(const World& world, BodyId body, double share, Stay& stay)
{
    if (travelled(world, body, stay) <= share * world.shapeOf(body).boundingRadius) {
        ++stay.frames;
    } else {
        stay = {world.motion[body].position, world.motion[body].orientation, 0};
    }
}

/// A ring that leans on two others and rocks loses next to nothing at each swing: nothing in a
/// world of rigid bodies takes that energy, and one such ring keeps a whole heap awake.
void settle(World& world, BodyId body, double acceleration, const Stay& nearby)
{
    if (acceleration == 0.0) return;
    const double unit = std::sqrt(world.shapeOf(body).boundingRadius / acceleration);
    if (nearby.frames * world.frameDuration < kSettleWait * unit) return;
    const double kept = 1.0 / (1.0 + world.frameDuration / (kSettleTime * unit));
    world.motion[body].velocity *= kept;
    world.motion[body].angularMomentum *= kept;
}

/// Wakes every sleeping body that lies with one of `roots`, through contacts that carried.
void wakeWith(World& world, std::vector<BodyId> roots)
{
    DisjointSets sets(world.bodyCount());
    const ContactMemory& memory = world.contactMemory;
    for (const RememberedContact& contact : memory.contacts) {
        if (memory.isAsleep(contact.a) && memory.isAsleep(contact.b)) {
            sets.join(static_cast<std::size_t>(contact.a), static_cast<std::size_t>(contact.b));
        }
    }
    std::vector<char> wakes(world.bodyCount(), 0);
    for (BodyId root : roots) wakes[sets.find(static_cast<std::size_t>(root))] = 1;
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        BodyRest& rest = world.contactMemory.rest[i];
        if (!rest.isAsleep || !wakes[sets.find(i)]) continue;
        rest.isAsleep = false;
        rest.still.frames = 0;
    }
}

/// Sleepers that stand closer than this share of the smaller one's size touch. No force has made
/// them press on each other yet, so the eye decides.
constexpr double kTouching = 0.01;

/// Contacts without force between sleeping bodies: what wakeWith follows.
std::vector<RememberedContact> contactsOfSleepers(const World& world)
{
    std::vector<Aabb> boxes(world.bodyCount());
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!world.contactMemory.isAsleep(body)) continue;
        const Shape& shape = world.shapeOf(body);
        boxes[i] = boxAt(shape, world.motion[i].worldFromBody())
                       .grown(0.5 * kTouching * shape.boundingRadius);
    }
    BroadPhase broadPhase;
    std::vector<RememberedContact> found;
    std::vector<GapContact> contacts;
    for (const BodyPair& pair : broadPhase.findPairs(boxes, world.mass)) {
        if (!mayCollide(world, pair)) continue;
        const PlacedPair placed{&world.shapeOf(pair.a), &world.shapeOf(pair.b),
                                world.motion[pair.a].worldFromBody(),
                                world.motion[pair.b].worldFromBody()};
        contacts.clear();
        NearFeatures().findContacts(placed, kTouching * smallerRadius(world, pair.a, pair.b),
                                    contacts);
        if (contacts.empty()) continue;
        const Quat aFromWorld = world.motion[pair.a].orientation.conjugate();
        found.push_back({pair.a, pair.b, contacts.front().feature, aFromWorld * contacts.front().rA,
                         Vec3::Zero()});
    }
    return found;
}

}  // namespace

void sleepFromTheStart(World& world, const StepSettings& settings,
                       const std::vector<BodyId>& bodies)
{
    if (bodies.empty()) return;
    std::vector<AppliedForce> forces;
    findForces(world, settings, world.frameDuration, forces);
    world.contactMemory.rest.resize(world.bodyCount());
    for (const BodyId body : bodies) {
        const BodyMotion& motion = world.motion[body];
        const Stay here{motion.position, motion.orientation, kStillFrames};
        world.contactMemory.rest[body] = {here, here, forces[body].acceleration, true};
    }
    world.contactMemory.contacts = contactsOfSleepers(world);
}

void fallAsleep(World& world, GapScratch& scratch)
{
    std::vector<BodyRest>& rest = world.contactMemory.rest;
    rest.resize(world.bodyCount());
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!isStepped(world, body)) continue;
        goOn(world, body, kStill, rest[i].still);
        goOn(world, body, kNearby, rest[i].nearby);
    }

    // A set sleeps when all of it is still and nothing that moves by a script carries it.
    DisjointSets sets(world.bodyCount());
    std::vector<char> isCarried(world.bodyCount(), 0), isDrivenSet(world.bodyCount(), 0),
        isRestless(world.bodyCount(), 0);
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
        isCarried[a] = isCarried[b] = 1;
        if (isStepped(world, row.a) && isStepped(world, row.b)) sets.join(a, b);
    }
    for (const GapRow& row : scratch.rows) {
        if (row.impulse.x() == 0.0) continue;
        for (const auto& [carrier, carried] : {std::pair{row.a, row.b}, std::pair{row.b, row.a}}) {
            if (isDriven(scratch.bodies[carrier]))
                isDrivenSet[sets.find(static_cast<std::size_t>(carried))] = 1;
        }
    }
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!isStepped(world, body)) continue;
        const std::size_t set = sets.find(i);
        if (rest[i].still.frames < kStillFrames || isDrivenSet[set]) isRestless[set] = 1;
        if (isCarried[i] && !isDrivenSet[set])
            settle(world, body, scratch.forces[i].acceleration.norm(), rest[i].nearby);
    }
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (!isStepped(world, static_cast<BodyId>(i)) || isRestless[sets.find(i)]) continue;
        rest[i].isAsleep = true;
        rest[i].pull = scratch.forces[i].acceleration;
        world.motion[i].velocity = world.motion[i].angularMomentum = Vec3::Zero();
    }
}

void wakeByForces(World& world, const std::vector<AppliedForce>& forces)
{
    std::vector<BodyId> roots;
    for (std::size_t i = 0; i < world.contactMemory.rest.size(); ++i) {
        const BodyRest& rest = world.contactMemory.rest[i];
        if (rest.isAsleep && rest.pull != forces[i].acceleration) {
            roots.push_back(static_cast<BodyId>(i));
        }
    }
    if (!roots.empty()) wakeWith(world, std::move(roots));
}

bool wakeByTouch(World& world, double dt, const GapScratch& scratch)
{
    std::vector<BodyId> roots;
    for (const GapPair& pair : scratch.pairs) {
        const auto [a, b] = pair.bodies;
        const bool aSleeps = world.contactMemory.isAsleep(a);
        if (aSleeps == world.contactMemory.isAsleep(b)) continue;
        const GapBody& bodyA = scratch.bodies[a];
        const GapBody& bodyB = scratch.bodies[b];
        const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
        for (const GapContact& contact : pair.contacts) {
            const Vec3 u = bodyA.velocity + dt * bodyA.pull + bodyA.spin.cross(contact.rA) -
                           bodyB.velocity - dt * bodyB.pull - bodyB.spin.cross(contact.rA + bFromA);
            if (std::max(contact.gap, 0.0) + dt * u.dot(contact.normal) >= 0.0) continue;
            roots.push_back(aSleeps ? a : b);
            break;
        }
    }
    if (roots.empty()) return false;
    wakeWith(world, std::move(roots));
    return true;
}

}  // namespace scree
