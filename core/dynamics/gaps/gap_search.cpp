// Symbols: reach the gap that may close within the step.
#include "core/dynamics/gaps/gap_search.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "core/base/fetch.h"
#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_lag.h"
#include "core/dynamics/gaps/gap_pace.h"
#include "core/dynamics/gaps/waking.h"
#include "core/dynamics/impulse.h"

namespace scree {
namespace {

/// Gaps below this share of the smaller body are contacts even when nothing moves: what lies within
/// the slop of push-out must not come and go.
constexpr double kLeastReach = 2e-4;

/// What two bodies have of their speed in common is looked for this far, as a share of the smaller
/// one. One of them may be stopped within the step, and the other run into it; but of bones that
/// pour down a funnel side by side a third of the time of a step went into looking for all of it.
constexpr double kCommonWay = 1e-3;

/// Near pairs that one thread lays out together.
constexpr std::size_t kPairsTogether = 512;

/// Pairs that one thread asks about together: many where there are many, most of them far, and one
/// of few: a fine nut on its bolt takes milliseconds.
constexpr std::size_t kPairsAskedTogether = 32, kAsksToShare = 16;

GapBody bodyOf(const World& world, const GapScratch& scratch, BodyId id)
{
    const BodyMotion& motion = world.motion[id];
    const PassInertia inertia = passInertia(world.mass[id], motion.orientation);
    GapBody body{};
    body.heavier = 1.0;
    body.velocity = motion.velocity;
    body.spin = inertia.inverseInertia * motion.angularMomentum;
    body.angularImpulse = body.shift = body.turn = Vec3::Zero();
    // Who sleeps is a fixed body to all others.
    const bool isAsleep = world.contactMemory.isAsleep(id);
    body.inverseMass = isAsleep ? 0.0 : inertia.inverseMass;
    body.inverseInertia = isAsleep ? Mat3(Mat3::Zero()) : inertia.turningByImpulse();
    body.pull = isAsleep ? Vec3(Vec3::Zero()) : scratch.forces[id].acceleration;
    body.torque = isAsleep ? Vec3(Vec3::Zero()) : scratch.forces[id].torque;
    return body;
}

/// What a step that nothing changes moves a body by.
RigidMotion motionIfFree(const GapBody& body, double dt)
{
    return {dt * body.velocity, dt * (body.spin + dt * (body.inverseInertia * body.torque))};
}

/// How far any points of the bodies move against each other in the step, at most [m].
double approachAnywhere(const GapScratch& scratch, BodyPair bodies, double dt)
{
    const GapPace &a = scratch.paces[bodies.a], &b = scratch.paces[bodies.b];
    const Vec3 relative = scratch.bodies[bodies.a].velocity - scratch.bodies[bodies.b].velocity;
    return dt * (relative.norm() + a.bySpin + b.bySpin);
}

/// The same of those that may meet.
double approachOf(const World& world, const GapScratch& scratch, BodyPair bodies, double dt)
{
    return farthestApproach(world, bodies, motionIfFree(scratch.bodies[bodies.a], dt),
                            motionIfFree(scratch.bodies[bodies.b], dt));
}

/// What else may close gaps within the step [m]. What both have in common and what pulls both alike
/// count too: one of them may be stopped in this very step, and the course of a falling wall that
/// was not told of the one below sank as deep into it as it fell in a step.
double reachBesides(const World& world, const GapScratch& scratch, BodyPair bodies, double dt)
{
    const GapPace &a = scratch.paces[bodies.a], &b = scratch.paces[bodies.b];
    const double smaller = smallerRadius(world, bodies.a, bodies.b);
    double inCommon = dt * std::min(a.speed, b.speed);
    if (!scratch.looksFar[bodies.a] && !scratch.looksFar[bodies.b])
        inCommon = std::min(inCommon, kCommonWay * smaller);
    const Vec3 apart = scratch.bodies[bodies.a].pull - scratch.bodies[bodies.b].pull;
    const double pull = std::max({a.pull, b.pull, apart.norm()});
    const double gain = scratch.gain[bodies.a] + scratch.gain[bodies.b];
    return inCommon + dt * (gain + dt * pull) + kLeastReach * smaller;
}

/// Everything the body may touch within the step.
Aabb boxWithin(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    if (!world.isBorn(body)) return {};  // an empty box meets nothing
    const Shape& shape = world.shapeOf(body);
    const Aabb box = boxAt(shape, world.motion[body].worldFromBody());
    if (shape.isPlane) return box;
    return box.grown(dt * (scratch.paces[body].fastest(dt) + scratch.gain[body]) +
                     kLeastReach * shape.boundingRadius + shape.bulge());
}

void readBodies(const World& world, double dt, bool isAgain, GapScratch& scratch)
{
    scratch.bodies.resize(world.bodyCount());
    scratch.boxes.resize(world.bodyCount());
    scratch.paces.resize(world.bodyCount());
    scratch.hasNews.resize(world.bodyCount());
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        const GapBody now = bodyOf(world, scratch, body);
        const bool hasWoken = now.isMovable() && !scratch.bodies[i].isMovable();
        scratch.hasNews[i] = !isAgain || hasWoken || scratch.gain[i] > 0.0 || scratch.looksFar[i];
        scratch.bodies[i] = now;
        if (!scratch.hasNews[i]) return;
        scratch.paces[i] = paceOf(world, scratch, body, dt);
        scratch.boxes[i] = boxWithin(world, scratch, body, dt);
    });
}

/// By impulses, or by what cannot be moved by these.
bool isMovedBody(const GapBody& body)
{
    return body.isMovable() || isDriven(body);
}

/// The pairs of this step, to be asked one and all. Both lists are sorted: pairs that stay keep
/// what they know.
void findGapPairs(const World& world, GapScratch& scratch)
{
    thread_local std::vector<char> isMoved;
    isMoved.resize(scratch.bodies.size());
    std::ranges::transform(scratch.bodies, isMoved.begin(), isMovedBody);
    const std::vector<BodyPair>& found = scratch.broadPhase.findPairs(
        scratch.boxes, world.mass, [&](BodyPair pair) { return mayCollide(world, pair); }, isMoved);
    std::vector<NearPair>& former = scratch.formerNearPairs;
    std::swap(scratch.nearPairs, former);
    scratch.nearPairs.resize(found.size());
    parallelFor(found.size(), kPairsTogether, [&](std::size_t begin, std::size_t end) {
        auto old = std::ranges::lower_bound(former, found[begin], {}, &NearPair::bodies);
        for (std::size_t i = begin; i < end; ++i) {
            while (old != former.end() && old->bodies < found[i]) ++old;
            NearPair& pair = scratch.nearPairs[i];
            if (old != former.end() && old->bodies == found[i]) {
                pair = std::move(*old);
            } else {
                pair = NearPair{};
                pair.bodies = found[i];
            }
        }
    });
    scratch.toAsk.resize(found.size());
    std::iota(scratch.toAsk.begin(), scratch.toAsk.end(), std::size_t{0});
}

/// Puts those among the near pairs that are not there yet.
void addNearPairs(const std::vector<BodyPair>& found, std::vector<NearPair>& nearPairs)
{
    std::vector<BodyPair> missing;
    for (const BodyPair& bodies : found) {
        if (!std::ranges::binary_search(nearPairs, bodies, {}, &NearPair::bodies))
            missing.push_back(bodies);
    }
    std::size_t from = nearPairs.size(), to = from + missing.size();
    nearPairs.resize(to);
    while (!missing.empty()) {
        NearPair& place = nearPairs[--to];
        if (from > 0 && missing.back() < nearPairs[from - 1].bodies) {
            place = std::move(nearPairs[--from]);
        } else {
            place = NearPair{};
            place.bodies = missing.back();
            missing.pop_back();
        }
    }
}

/// For another attempt: the pairs of bodies of which there are news. What nobody needs to look at
/// again is not looked at, or in a large world all of it would be in every step.
void findNewGapPairs(const World& world, GapScratch& scratch)
{
    const std::vector<BodyPair>& found = scratch.broadPhase.findPairs(
        scratch.boxes, world.mass, [&](BodyPair pair) { return isMovedPair(world, scratch, pair); },
        scratch.hasNews);
    addNearPairs(found, scratch.nearPairs);
    scratch.toAsk.clear();
    for (const BodyPair& bodies : found) {
        const auto pair =
            std::ranges::lower_bound(scratch.nearPairs, bodies, {}, &NearPair::bodies);
        scratch.toAsk.push_back(static_cast<std::size_t>(pair - scratch.nearPairs.begin()));
    }
}

/// What is asked of a pair.
struct Question {
    NearPair* pair;
    double reach;
};

/// Whether the pair is known to have no contacts within the step, which is noted then, be it by
/// what has been remembered of it longer than a checkpoint remembers: that tells nothing else, and
/// nothing else may depend on it. Most pairs are so far apart that nobody needs to know how they
/// approach.
bool noteIfFar(const World& world, const GapScratch& scratch, double besides, double ahead,
               double dt, NearPair& pair)
{
    if (!pair.contacts.empty()) return false;
    const double reach = besides + approachAnywhere(scratch, pair.bodies, dt) + ahead;
    if (reach >= apartAtLeast(world, scratch, pair)) return false;
    pair.foundWithin = reach;
    return true;
}

/// Whether the contacts that are known of a pair serve this look too, which reaches for `reach`,
/// and has to for `least` [m]. They go along with their bodies where that is all they need.
bool contactsServe(const World& world, const GapScratch& scratch, double least, double reach,
                   bool hasMoved, NearPair& pair)
{
    if (pair.contacts.empty()) return !hasMoved && reach <= pair.foundWithin;
    if (isSoughtAnewAt(world.clock))
        return !hasMoved && !pair.isLagged && reach == pair.foundWithin;
    return hasMoved ? takeContactsAlong(world, scratch, least, pair) : least <= pair.foundWithin;
}

/// Notes the pairs whose contacts are not known, of those to ask.
void askPairs(const World& world, double dt, bool isAgain, std::span<const std::size_t> toAsk,
              GapScratch& scratch, std::vector<Question>& questions)
{
    for (std::size_t i = 0; i < toAsk.size(); ++i) {
        if (i + kPairsAhead < toAsk.size()) {
            const NearPair& ahead = scratch.nearPairs[toAsk[i + kPairsAhead]];
            const BodyId b = ahead.bodies.b;
            fetchLines(&scratch.paces[b], &scratch.paces[b] + 1);
            fetchLines(&scratch.bodies[b], &scratch.bodies[b].inverseMass);
            fetchLines(&world.motion[b], &world.motion[b].orientation);
            fetchItems(ahead.contacts);
        }
        NearPair& pair = scratch.nearPairs[toAsk[i]];
        const auto [a, b] = pair.bodies;
        const double besides = reachBesides(world, scratch, pair.bodies, dt);
        const double ahead = lookAheadToLag(world, scratch, pair.bodies, dt);
        if (noteIfFar(world, scratch, besides, ahead, dt, pair)) continue;
        const double least = besides + approachOf(world, scratch, pair.bodies, dt);
        const double reach = least + ahead;
        const bool hasMoved = !isAgain && (scratch.moves[a].hasMoved || scratch.moves[b].hasMoved);
        if (contactsServe(world, scratch, least, reach, hasMoved, pair)) continue;
        pair.soughtIn = scratch.attempt;
        pair.contacts.clear();
        pair.foundWithin = reach;
        pair.isLagged = false;
        pair.depth = 0.0;
        if (reach >= apartAtLeast(world, scratch, pair)) questions.push_back({&pair, reach});
    }
}

/// Contacts are found in one place and kept in as much memory as they need: before they are reduced
/// there are several times as many.
void answer(const World& world, const GapScratch& scratch, std::span<const Question> questions)
{
    thread_local std::vector<GapContact> found;
    for (std::size_t i = 0; i < questions.size(); ++i) {
        if (i + 2 < questions.size()) questions[i + 2].pair->features.prefetch();
        if (i + 1 < questions.size()) questions[i + 1].pair->features.prefetchLists();
        auto& [pair, reach] = questions[i];
        found.clear();
        const double apart =
            pair->features.findContacts(placePair(world, pair->bodies), reach, found);
        seeApart(world, scratch, apart, *pair);
        pair->contacts.assign(found.begin(), found.end());
        if (found.empty()) pair->contacts.shrink_to_fit();
        pair->depth = deepestOf(found);
    }
}

/// Who is touched wakes, and then has gaps of his own to look for: until nobody wakes any more.
/// `isAgain`: in a further attempt at the step.
void seek(World& world, double dt, bool isAgain, GapScratch& scratch)
{
    ++scratch.attempt;
    do {
        readBodies(world, dt, isAgain, scratch);
        if (isAgain)
            findNewGapPairs(world, scratch);
        else
            findGapPairs(world, scratch);
        const std::size_t most = scratch.toAsk.size() / kAsksToShare;
        const std::size_t grain = std::clamp<std::size_t>(most, 1, kPairsAskedTogether);
        parallelFor(scratch.toAsk.size(), grain, [&](std::size_t begin, std::size_t end) {
            thread_local std::vector<Question> questions;
            questions.clear();
            askPairs(world, dt, isAgain, std::span(scratch.toAsk).subspan(begin, end - begin),
                     scratch, questions);
            answer(world, scratch, questions);
        });
        isAgain = true;
    } while (wakeByTouch(world, dt, scratch));
}

}  // namespace

bool isMovedPair(const World& world, const GapScratch& scratch, BodyPair pair)
{
    const bool isMoved = isMovedBody(scratch.bodies[pair.a]) || isMovedBody(scratch.bodies[pair.b]);
    return isMoved && mayCollide(world, pair);
}

void findGaps(World& world, const StepSettings& settings, double dt, GapScratch& scratch)
{
    findForces(world, settings, dt, scratch.forces);
    followBodies(world, scratch);
    scratch.gain.assign(world.bodyCount(), 0.0);
    scratch.looksFar.assign(world.bodyCount(), 0);
    scratch.unseen.diverted.clear();
    seek(world, dt, false, scratch);
}

void findGapsAgain(World& world, double dt, GapScratch& scratch)
{
    seek(world, dt, true, scratch);
}

}  // namespace scree
