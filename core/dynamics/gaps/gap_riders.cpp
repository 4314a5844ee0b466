#include "core/dynamics/gaps/gap_riders.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/dynamics/integrator.h"

namespace scree {
namespace {

/// What differs from the motion of a carrier by more than this share of what would be changed has
/// not been carried.
constexpr double kAlongWith = 0.5;

/// In how many halvings of the step it is found when a rider leaves.
constexpr int kCuts = 20;

struct Rider {
    BodyId body, carrier;
    Vec3 force;  // of the carrier on it
};

/// The way of a script in this step, and how contacts have seen it in the last one.
class Carrier {
public:
    Carrier(const World& world, BodyId body)
        : world_(world),
          body_(body),
          moment_(kJustBefore * world.frameDuration),
          seen_(scriptedMotion(world, body, -world.contactMemory.dt, 0.0))
    {
    }

    const ScriptedMotion& seen() const { return seen_; }
    double moment() const { return moment_; }
    ScriptedMotion at(double t) const { return scriptedMotion(world_, body_, t - moment_, t); }

    /// Until when it is not slower, along a direction, than what it lets go of at the beginning and
    /// what `pull` pulls that way; dt if it never is.
    double bearsUntil(const Vec3& x, const Vec3& along, double pull, double dt) const
    {
        const double first = at(0.0).velocityAt(x).dot(along);
        const auto isSlower = [&](double t) {
            return at(t).velocityAt(x).dot(along) < first + t * pull;
        };
        if (!isSlower(dt)) return dt;
        double bears = 0.0, leaves = dt;
        for (int cut = 0; cut < kCuts; ++cut) {
            const double t = 0.5 * (bears + leaves);
            (isSlower(t) ? leaves : bears) = t;
        }
        return bears;
    }

private:
    const World& world_;
    BodyId body_;
    double moment_;
    ScriptedMotion seen_;
};

/// Whether a script has moved it throughout the last step.
bool isCarrier(const World& world, BodyId body)
{
    const Clock& clock = world.clock;
    const bool isFirst = clock.frame == world.info[body].keyedFrom && clock.subStep == 0 &&
                         clock.frameTimeDone == 0.0;
    return world.info[body].kind == BodyKind::keyed && !isFirst;
}

/// Sorted as the contacts are.
void findRiders(const World& world, const GapScratch& scratch, std::vector<Rider>& riders)
{
    riders.clear();
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (contact.force.isZero(0.0)) continue;
        for (const auto& [body, carrier, sign] :
             {std::tuple{contact.a, contact.b, 1.0}, std::tuple{contact.b, contact.a, -1.0}}) {
            if (!scratch.bodies[body].isMovable() || !isCarrier(world, carrier)) continue;
            const bool isKnown =
                !riders.empty() && riders.back().body == body && riders.back().carrier == carrier;
            if (!isKnown) riders.push_back({body, carrier, Vec3::Zero()});
            riders.back().force += sign * contact.force;
        }
    }
}

bool isStillCarried(const GapScratch& scratch, const Rider& rider)
{
    const BodyPair bodies{std::min(rider.body, rider.carrier), std::max(rider.body, rider.carrier)};
    const auto pair = std::ranges::lower_bound(scratch.pairs, bodies, {}, &GapPair::bodies);
    if (pair == scratch.pairs.end() || !(pair->bodies == bodies)) return false;
    return std::ranges::any_of(scratch.rowsOf(*pair),
                               [](const GapRow& row) { return row.wasHit || row.carries(); });
}

/// What a body has more of the velocity of its carrier than it should, as contacts have seen that;
/// along the force alone if it slides or rolls there. Nothing of what moves another way.
Vec3 excessOf(const Vec3& slip, const Vec3& excess, const Vec3& along)
{
    if (slip.norm() <= kAlongWith * excess.norm()) return excess;
    const double part = excess.dot(along);
    return std::abs(slip.dot(along)) <= kAlongWith * std::abs(part) ? Vec3(part * along)
                                                                    : Vec3(Vec3::Zero());
}

/// On its own since the carrier has fallen behind. What has left in another way, or has been hit
/// since, goes on as it does.
void fly(const World& world, double dt, BodyId id, const Rider& rider, GapBody& body)
{
    if (body.hitAt > 0.0) return;
    const Carrier carrier(world, rider.carrier);
    const Vec3& x = world.motion[id].position;
    const Vec3 along = rider.force.normalized();
    const double pull = body.pull.dot(along);
    const double bears = carrier.bearsUntil(x, along, pull, dt);
    if (bears == dt) return;
    const ScriptedMotion left = carrier.at(bears - carrier.moment());  // not beyond a kink
    const Vec3 seen =
        carrier.seen().velocityAt(x - world.contactMemory.dt * world.motion[id].velocity);
    const Vec3 excess = excessOf(world.motion[id].velocity - seen,
                                 seen + bears * pull * along - left.velocityAt(x), along);
    if (excess.isZero(0.0)) return;
    body.velocity -= excess;
    body.velocityBefore -= excess;
    if (body.isStopped) body.shift -= 0.5 * dt * (body.velocity - body.velocityBefore);
    body.isStopped = false;

    const Vec3 spin = angularVelocity(world.motion[id], world.mass[id]);
    const Vec3 more = carrier.seen().spin - left.spin;
    if (more.isZero(0.0) || (spin - carrier.seen().spin).norm() > kAlongWith * more.norm()) return;
    body.spin -= more;
    body.spinBefore -= more;
    body.angularImpulse -= body.inverseInertia.inverse() * more;
}

}  // namespace

void letRidersGo(const World& world, double dt, GapScratch& scratch)
{
    const auto isKeyed = [](const BodyInfo& body) { return body.kind == BodyKind::keyed; };
    if (std::ranges::none_of(world.info, isKeyed)) return;
    thread_local std::vector<Rider> riders;
    findRiders(world, scratch, riders);
    const auto leaves = [&](const Rider& rider) { return !isStillCarried(scratch, rider); };
    if (std::ranges::none_of(riders, leaves)) return;

    // What lay on each other leaves together.
    DisjointSets heaps(world.bodyCount());
    const auto heapOf = [&](BodyId body) { return heaps.find(static_cast<std::size_t>(body)); };
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (scratch.bodies[contact.a].isMovable() && scratch.bodies[contact.b].isMovable())
            heaps.join(static_cast<std::size_t>(contact.a), static_cast<std::size_t>(contact.b));
    }
    std::vector<const Rider*> first(world.bodyCount(), nullptr);  // per heap
    std::vector<char> isHeld(world.bodyCount(), 0);
    for (const Rider& rider : riders) {
        const std::size_t heap = heapOf(rider.body);
        if (!first[heap]) first[heap] = &rider;
        isHeld[heap] = isHeld[heap] || !leaves(rider);
    }
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        const std::size_t heap = heapOf(body);
        if (!scratch.bodies[i].isMovable() || !first[heap] || isHeld[heap]) continue;
        fly(world, dt, body, *first[heap], scratch.bodies[i]);
    }
}

}  // namespace scree
