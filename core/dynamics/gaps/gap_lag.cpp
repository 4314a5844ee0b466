#include "core/dynamics/gaps/gap_lag.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Steps from one that seeks all contacts anew to the next. With eight nothing gets faster.
constexpr std::int64_t kLagSteps = 4;

/// A pair whose points move farther than this share of the smaller body in a step is sought anew.
/// At twice as much nothing gets faster.
constexpr double kMostWay = 1e-3;

/// How much faster a pair may get before its contacts have to be sought anew.
constexpr double kSpeedUp = 1.1;
constexpr double kWayMore = 0.1 * kMostWay;  // as a share of the smaller body

/// The place of a round contact is no point of its bodies: it stays below what rolls, and if it
/// went along it would push that on.
bool isRound(const GapContact& contact)
{
    return kindOf(contact.feature) == FeatureKind::round;
}

}  // namespace

void followBodies(const World& world, GapScratch& scratch)
{
    const std::size_t known = scratch.seenAt.size();
    scratch.seenAt.resize(world.bodyCount());
    scratch.moves.resize(world.bodyCount());
    scratch.turned.resize(world.bodyCount(), 0.0);
    forEach(world.bodyCount(), kShortWork, [&](std::size_t i) {
        const Pose pose = world.motion[i].worldFromBody();
        Pose& then = scratch.seenAt[i];
        BodyMove& move = scratch.moves[i];
        move = {};
        move.hasMoved = i >= known || pose.position != then.position ||
                        pose.orientation.coeffs() != then.orientation.coeffs();
        if (i < known && move.hasMoved) {
            const Shape& shape = world.shapeOf(static_cast<BodyId>(i));
            const double turned = chordOfTurn(then.orientation, pose.orientation);
            move.turn = (pose.orientation * then.orientation.conjugate()).toRotationMatrix();
            move.shift = pose.position - then.position;
            const double byTurn = turned * shape.boundingRadius;
            move.way = move.shift.norm() + byTurn;
            scratch.turned[i] += byTurn;
        }
        then = pose;
    });
}

void seeApart(const World& world, const GapScratch& scratch, double distance, NearPair& pair)
{
    const auto [a, b] = pair.bodies;
    pair.seen = {distance, world.motion[a].position - world.motion[b].position,
                 scratch.turned[a] + scratch.turned[b]};
}

double apartAtLeast(const World& world, const GapScratch& scratch, const NearPair& pair)
{
    const auto [a, b] = pair.bodies;
    const Vec3 between = world.motion[a].position - world.motion[b].position;
    const double turned = scratch.turned[a] + scratch.turned[b] - pair.seen.turned;
    return pair.seen.distance - (between - pair.seen.between).norm() - turned;
}

bool isSoughtAnewAt(const Clock& clock)
{
    return clock.subStep % kLagSteps == 0;
}

double lookAheadToLag(const World& world, const GapScratch& scratch, BodyPair bodies, double dt)
{
    const Clock& clock = world.clock;
    const double left = world.frameDuration - clock.frameTimeDone - dt;
    const auto untilAnew = static_cast<double>(kLagSteps - 1 - clock.subStep % kLagSteps);
    const double steps = std::min(untilAnew, std::ceil(left / dt));
    const GapPace &a = scratch.paces[bodies.a], &b = scratch.paces[bodies.b];
    const double way = dt * (a.speed + a.bySpin + b.speed + b.bySpin);
    const double smaller = smallerRadius(world, bodies.a, bodies.b);
    if (!(steps > 0.0) || way > kMostWay * smaller) return 0.0;
    return kSpeedUp * steps * way + kWayMore * smaller;
}

bool takeContactsAlong(const World& world, const GapScratch& scratch, double reach, NearPair& pair)
{
    const BodyMove& a = scratch.moves[pair.bodies.a];
    const BodyMove& b = scratch.moves[pair.bodies.b];
    const double way = a.way + b.way;
    if (!(reach + way <= pair.foundWithin)) return false;
    if (way > kMostWay * smallerRadius(world, pair.bodies.a, pair.bodies.b)) return false;
    if (std::any_of(pair.contacts.begin(), pair.contacts.end(), isRound)) return false;
    const Vec3 fromAToB =
        world.motion[pair.bodies.b].position - world.motion[pair.bodies.a].position;
    const PairMove move{a.turn, b.turn, fromAToB - b.shift + a.shift, fromAToB};
    for (GapContact& contact : pair.contacts) contact = movedAlong(contact, move);
    pair.foundWithin -= way;
    pair.isLagged = true;
    pair.depth = deepestOf(pair.contacts);
    return true;
}

}  // namespace scree
