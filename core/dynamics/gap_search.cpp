// Symbols: reach the gap that may close within the step.
#include "core/dynamics/gap_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/parallel.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/sleep.h"

namespace scree {
namespace {

/// Gaps below this share of the smaller body are contacts even when nothing moves: what lies within
/// the slop of push-out must not come and go.
constexpr double kLeastReach = 2e-4;

/// An overlap that the eye may see, as a share of the smaller body.
constexpr double kVisible = 5e-3;

/// Near pairs that one thread lays out together.
constexpr std::size_t kPairsTogether = 512;

bool isBefore(const NearPair& pair, const BodyPair& bodies)
{
    return pair.bodies < bodies;
}

GapBody bodyOf(const World& world, const GapScratch& scratch, BodyId id)
{
    const BodyMotion& motion = world.motion[id];
    const PassInertia inertia = passInertia(world.mass[id], motion.orientation);
    GapBody body{};
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

GapPace paceOf(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    const GapBody& b = scratch.bodies[body];
    const Shape& shape = world.shapeOf(body);
    GapPace pace{b.velocity.norm(), 0.0, b.pull.norm()};
    if (!shape.isPlane) {
        const double spin = b.spin.norm() + dt * (b.inverseInertia * b.torque).norm();
        pace.bySpin = spin * shape.boundingRadius;
    }
    return pace;
}

void readOdometers(const World& world, GapScratch& scratch)
{
    const std::size_t known = scratch.seenAt.size();
    scratch.seenAt.resize(world.bodyCount());
    scratch.hasMoved.assign(world.bodyCount(), true);
    scratch.odometer.resize(world.bodyCount(), 0.0);
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const Pose pose = world.motion[i].worldFromBody();
        const Pose& then = scratch.seenAt[i];
        if (i < known) {
            const Shape& shape = world.shapeOf(static_cast<BodyId>(i));
            // The chord of a point at unit distance.
            const double turned =
                2.0 * (pose.orientation * then.orientation.conjugate()).vec().norm();
            scratch.odometer[i] += (pose.position - then.position).norm();
            const double farthest =
                shape.isPlane ? std::numeric_limits<double>::infinity() : shape.boundingRadius;
            if (turned > 0.0) scratch.odometer[i] += turned * farthest;
            scratch.hasMoved[i] = pose.position != then.position ||
                                  pose.orientation.coeffs() != then.orientation.coeffs();
        }
        scratch.seenAt[i] = pose;
    });
}

/// Gaps that may close within the step. The speed that both have in common and what pulls both
/// alike count too: one of them may be stopped in this very step, and the course of a falling wall
/// that was not told of the one below sank as deep into it as it fell in a step.
double reachOf(const World& world, const GapScratch& scratch, BodyPair bodies, const GapPace& a,
               const GapPace& b, double dt)
{
    const GapBody& bodyA = scratch.bodies[bodies.a];
    const GapBody& bodyB = scratch.bodies[bodies.b];
    const double inCommon = std::min(a.speed, b.speed);
    const double speed = (bodyA.velocity - bodyB.velocity).norm() + inCommon + a.bySpin + b.bySpin;
    const double pull = std::max({a.pull, b.pull, (bodyA.pull - bodyB.pull).norm()});
    const double gain = scratch.gain[bodies.a] + scratch.gain[bodies.b];
    return dt * (speed + gain + dt * pull) + kLeastReach * smallerRadius(world, bodies.a, bodies.b);
}

/// Everything the body may touch within the step.
Aabb boxWithin(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    if (!world.isBorn(body)) return {};  // an empty box meets nothing
    const Shape& shape = world.shapeOf(body);
    const Aabb box = boxAt(shape, world.motion[body].worldFromBody());
    if (shape.isPlane) return box;
    return box.grown(dt * (scratch.paces[body].fastest(dt) + scratch.gain[body]) +
                     kLeastReach * shape.boundingRadius + shape.smooth.bulge());
}

bool isMovedPair(const World& world, const GapScratch& scratch, BodyPair pair)
{
    const GapBody &a = scratch.bodies[pair.a], &b = scratch.bodies[pair.b];
    const bool isMoved = a.inverseMass > 0.0 || b.inverseMass > 0.0 || isDriven(a) || isDriven(b);
    return isMoved && mayCollide(world, pair);
}

void readBodies(const World& world, double dt, GapScratch& scratch)
{
    scratch.bodies.resize(world.bodyCount());
    scratch.gain.resize(world.bodyCount(), 0.0);
    scratch.boxes.resize(world.bodyCount());
    scratch.paces.resize(world.bodyCount());
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const auto body = static_cast<BodyId>(i);
        scratch.bodies[i] = bodyOf(world, scratch, body);
        scratch.paces[i] = paceOf(world, scratch, body, dt);
        scratch.boxes[i] = boxWithin(world, scratch, body, dt);
    });
}

void findGapPairs(const World& world, GapScratch& scratch)
{
    const std::vector<BodyPair>& found = scratch.broadPhase.findPairs(
        scratch.boxes, world.mass,
        [&](BodyPair pair) { return isMovedPair(world, scratch, pair); });

    // Both lists are sorted: pairs that stay keep what they know.
    std::vector<NearPair>& former = scratch.formerNearPairs;
    std::swap(scratch.nearPairs, former);
    scratch.nearPairs.resize(found.size());
    parallelFor(found.size(), kPairsTogether, [&](std::size_t begin, std::size_t end) {
        auto old = std::lower_bound(former.begin(), former.end(), found[begin], isBefore);
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
}

double odometerOf(const GapScratch& scratch, BodyPair bodies)
{
    return scratch.odometer[bodies.a] + scratch.odometer[bodies.b];
}

/// What is asked of a pair.
struct Question {
    NearPair* pair;
    double reach;
};

/// Notes the pairs whose contacts are not what they were. A step that is solved again asks again,
/// most of it the same.
void askPairs(const World& world, double dt, bool isAgain, const GapScratch& scratch,
              std::span<NearPair> pairs, std::vector<Question>& questions)
{
    for (NearPair& pair : pairs) {
        const auto [a, b] = pair.bodies;
        const double reach =
            reachOf(world, scratch, pair.bodies, scratch.paces[a], scratch.paces[b], dt);
        const bool hasMoved = !isAgain && (scratch.hasMoved[a] || scratch.hasMoved[b]);
        if (!hasMoved && reach == pair.foundWithin) continue;
        pair.contacts.clear();
        pair.foundWithin = reach;
        pair.depth = 0.0;
        if (reach + odometerOf(scratch, pair.bodies) >= pair.farUntil)
            questions.push_back({&pair, reach});
    }
}

/// Contacts are found in one place and kept in as much memory as they need: before they are reduced
/// there are several times as many.
void answer(const World& world, const GapScratch& scratch, std::span<const Question> questions)
{
    thread_local std::vector<GapContact> found;
    for (std::size_t i = 0; i < questions.size(); ++i) {
        if (i + 2 < questions.size()) questions[i + 2].pair->near.prefetch();
        if (i + 1 < questions.size()) questions[i + 1].pair->near.prefetchLists();
        auto& [pair, reach] = questions[i];
        found.clear();
        pair->farUntil = odometerOf(scratch, pair->bodies) +
                         pair->near.findContacts(placePair(world, pair->bodies), reach, found);
        pair->contacts.assign(found.begin(), found.end());
        if (found.empty()) pair->contacts.shrink_to_fit();
        pair->depth = deepestOf(pair->contacts);
    }
}

/// As solved, do the bodies run visibly into each other where they were not looked at?
bool runsIntoUnseen(const World& world, double dt, GapScratch& scratch, BodyPair bodies)
{
    const auto known =
        std::lower_bound(scratch.nearPairs.begin(), scratch.nearPairs.end(), bodies, isBefore);
    const bool isKnown = known != scratch.nearPairs.end() && known->bodies == bodies;
    NearFeatures ofNone;
    NearFeatures& near = isKnown ? known->near : ofNone;
    const auto [a, b] = bodies;
    const double reach = reachOf(world, scratch, bodies, paceOf(world, scratch, a, dt),
                                 paceOf(world, scratch, b, dt), dt);
    if (isKnown && reach + odometerOf(scratch, bodies) < known->farUntil) return false;
    std::vector<GapContact> contacts;
    near.findContacts(placePair(world, bodies), reach, contacts);
    const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
    return std::any_of(contacts.begin(), contacts.end(), [&](const GapContact& contact) {
        if (isKnown && contact.gap < known->foundWithin) return false;
        GapRow row{};
        row.rA = contact.rA;
        row.rB = contact.rA + bFromA;
        row.normal = contact.normal;
        const GapBody &bodyA = scratch.bodies[a], &bodyB = scratch.bodies[b];
        const double opened =
            shiftAt(row, bodyA, bodyB) + dt * velocityAt(row, bodyA, bodyB).dot(row.normal);
        return contact.gap + opened < -kVisible * smallerRadius(world, a, b);
    });
}

}  // namespace

void findGaps(World& world, const StepSettings& settings, double dt, GapScratch& scratch)
{
    findForces(world, settings, dt, scratch.forces);
    wakeByForces(world, scratch.forces);
    readOdometers(world, scratch);
    bool isAgain = false;
    do {
        readBodies(world, dt, scratch);
        findGapPairs(world, scratch);
        parallelFor(scratch.nearPairs.size(), 32, [&](std::size_t begin, std::size_t end) {
            thread_local std::vector<Question> questions;
            questions.clear();
            askPairs(world, dt, isAgain, scratch,
                     std::span(scratch.nearPairs).subspan(begin, end - begin), questions);
            answer(world, scratch, questions);
        });
        isAgain = true;
    } while (wakeByTouch(world, dt, scratch));
}

bool meetsUnseen(const World& world, double dt, GapScratch& scratch)
{
    std::vector<double> gain(world.bodyCount(), 0.0);
    std::vector<char> isFaster(world.bodyCount(), 0);
    std::vector<Aabb> boxes = scratch.boxes;
    bool isAnyFaster = false;
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (scratch.bodies[i].inverseMass == 0.0) continue;
        const double faster = paceOf(world, scratch, body, dt).fastest(dt) -
                              scratch.paces[i].fastest(dt) - scratch.gain[i];
        if (dt * faster <= kVisible * world.shapeOf(body).boundingRadius) continue;
        gain[i] = scratch.gain[i] + faster;
        boxes[i] = boxes[i].grown(dt * faster);
        isFaster[i] = isAnyFaster = true;
    }
    if (!isAnyFaster) return false;

    const std::vector<BodyPair>& pairs = scratch.broadPhase.findPairs(
        boxes, world.mass, [&](BodyPair pair) { return isMovedPair(world, scratch, pair); },
        isFaster);
    std::vector<char> isMet(pairs.size(), 0);
    parallelFor(pairs.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            isMet[i] = runsIntoUnseen(world, dt, scratch, pairs[i]);
    });
    bool isAnyMet = false;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!isMet[i]) continue;
        isAnyMet = true;
        for (const BodyId body : {pairs[i].a, pairs[i].b})
            scratch.gain[body] = std::max(scratch.gain[body], gain[body]);
    }
    return isAnyMet;
}

}  // namespace scree
