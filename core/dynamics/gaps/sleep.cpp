#include "core/dynamics/gaps/sleep.h"

#include <algorithm>

#include "core/collision/broad_phase.h"
#include "core/collision/near_features.h"
#include "core/dynamics/gaps/contact_load.h"
#include "core/dynamics/gaps/stillness.h"

namespace scree {
namespace {

/// Sleepers that stand closer than this share of the smaller one's size touch. No force has made
/// them press on each other yet, so the eye decides.
constexpr double kTouching = 0.01;

/// What pushes less against the pull than this share of its force leans, and holds nothing up.
constexpr double kHoldsUp = 0.02;

/// Contacts without force of sleeping bodies with each other, which waking follows, and with
/// those that a script may take away.
std::vector<RememberedContact> contactsOfSleepers(const World& world)
{
    std::vector<Aabb> boxes(world.bodyCount());
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        const bool isScripted = world.info[i].kind == BodyKind::keyed && world.isBorn(body);
        if (!world.contactMemory.isAsleep(body) && !isScripted) continue;
        const Shape& shape = world.shapeOf(body);
        boxes[i] = boxAt(shape, world.motion[i].worldFromBody())
                       .grown(0.5 * kTouching * shape.boundingRadius);
    }
    BroadPhase broadPhase;
    std::vector<RememberedContact> found;
    std::vector<GapContact> contacts;
    const auto counts = [&](BodyPair pair) { return mayCollide(world, pair); };
    for (const BodyPair& pair : broadPhase.findPairs(boxes, world.mass, counts)) {
        contacts.clear();
        NearFeatures().findContacts(placePair(world, pair),
                                    kTouching * smallerRadius(world, pair.a, pair.b), contacts);
        if (contacts.empty()) continue;
        const Quat aFromWorld = world.motion[pair.a].orientation.conjugate();
        found.push_back({pair.a, pair.b, contacts.front().feature, aFromWorld * contacts.front().rA,
                         Vec3::Zero()});
    }
    return found;
}

/// Whether a body that has not been seen to move for so many frames, and on which nothing but what
/// balances acts, lies. What flies where nothing pulls does not.
bool liesStill(const World& world, BodyId body, double frames, const ContactLoad& load,
               const AppliedForce& other)
{
    const BodyMotion& motion = world.motion[body];
    if (motion.velocity.isZero(0.0) && motion.angularMomentum.isZero(0.0))
        return frames >= kStillFrames;
    const double held = load.total * world.mass[body].inverseMass;
    const double acceleration = std::max(other.acceleration.norm(), held);
    return acceleration > 0.0 && frames >= framesToSleep(world, body, acceleration);
}

/// Whether the impulse of a row on a body holds it up against what pulls it; in a world without
/// pull everything that touches does.
bool isHeldUpBy(const GapRow& row, const Vec3& impulse, const Vec3& pull)
{
    return impulse.dot(-pull) > kHoldsUp * row.impulse.norm() * pull.norm() || pull.isZero(0.0);
}

/// Of those that may sleep takes out whom anything holds up that is awake or moved by a script.
void keepAwakeWhoIsHeldUp(const World& world, const GapScratch& scratch,
                          std::vector<char>& maySleep)
{
    const auto lies = [&](BodyId body) {
        return maySleep[body] || world.contactMemory.isAsleep(body) ||
               (!scratch.bodies[body].isMovable() && !isDriven(scratch.bodies[body]));
    };
    bool isSettled = false;
    while (!isSettled) {
        isSettled = true;
        for (const std::size_t i : scratch.order) {  // bottom to top: few rounds
            for (const GapRow& row : scratch.rowsOf(scratch.pairs[i])) {
                if (!row.carries()) continue;
                const Vec3 impulse = row.worldImpulse();
                const auto keepIfHeldUp = [&](BodyId body, BodyId by, const Vec3& push) {
                    if (!maySleep[body] || lies(by)) return;
                    if (!isHeldUpBy(row, push, scratch.forces[body].acceleration)) return;
                    maySleep[body] = 0;
                    isSettled = false;
                };
                keepIfHeldUp(row.a, row.b, impulse);
                keepIfHeldUp(row.b, row.a, -impulse);
            }
        }
    }
}

/// Per body: whether it is awake, lies still and balanced, and is held up only by what does too.
std::vector<char> whoMaySleep(const World& world, const GapScratch& scratch)
{
    const std::vector<BodyRest>& rest = world.contactMemory.rest;
    const std::vector<ContactLoad> loads =
        rememberedLoads(world, [](BodyId, BodyId) { return true; });
    std::vector<char> maySleep(world.bodyCount(), 0);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!world.isStepped(body)) continue;
        // What is about to be woken again need not fall asleep: under a force that grew a box began
        // to slide a tenth of a second late.
        if (!isPulledAsBefore(rest[i], scratch.forces[i])) continue;
        maySleep[i] = liesStill(world, body, rest[i].still.frames, loads[i], scratch.forces[i]) &&
                      isBalanced(world, body, loads[i], scratch.forces[i], kBalanced);
    }
    keepAwakeWhoIsHeldUp(world, scratch, maySleep);
    return maySleep;
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
        const Stay here{motion.position, motion.orientation, 0};
        world.contactMemory.rest[body] = {here, here, here, forces[body].acceleration, true};
    }
    world.contactMemory.contacts = contactsOfSleepers(world);
}

void fallAsleep(World& world, const StepSettings& settings, const GapScratch& scratch)
{
    std::vector<BodyRest>& rest = world.contactMemory.rest;
    rest.resize(world.bodyCount());
    noteStays(world, scratch.forces);
    const std::vector<char> maySleep = whoMaySleep(world, scratch);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (world.isStepped(body)) rest[i].pull = scratch.forces[i].acceleration;
    }
    if (std::ranges::find(maySleep, 1) == maySleep.end()) return;
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (!maySleep[i]) continue;
        rest[i].isAsleep = true;
        world.motion[i].velocity = world.motion[i].angularMomentum = Vec3::Zero();
    }
    // As the next frame will ask: what wind does to a body depends a little on the step.
    std::vector<AppliedForce> forces;
    findForces(world, settings, world.frameDuration, forces);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (maySleep[i]) rest[i].pull = forces[i].acceleration;
    }
}

}  // namespace scree
