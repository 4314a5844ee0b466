#include "core/dynamics/push_out.h"

#include <Eigen/Cholesky>

#include <algorithm>

#include "core/base/parallel.h"
#include "core/dynamics/contact_point.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

struct Push {
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();
};

Push pushFrom(const PassInertia& inertia, const Vec3& r, const Vec3& impulse)
{
    if (!inertia.isMovable()) return {};
    return {inertia.inverseMass * impulse, inertia.inverseInertia * r.cross(impulse)};
}

void move(BodyMotion& motion, const Push& push)
{
    motion.position += push.shift;
    motion.orientation = rotated(motion.orientation, push.turn);
}

/// One push at the deepest overlap of the pair. False when nothing overlaps.
bool pushOnce(World& world, PairRecord& pair, const PairVisit& visit, const FrozenBodies& frozen,
              const StepSettings& settings, PushOutTally& tally)
{
    const auto [a, b] = pair.bodies;
    const auto inertiaOf = [&](BodyId body) {
        return fixedIf(frozen.isFrozen(body, visit.level),
                       passInertia(world.mass[body], world.motion[body].orientation));
    };
    const PassInertia inertiaA = fixedIf(pair.aIsUnmoved, inertiaOf(a));
    const PassInertia inertiaB = fixedIf(pair.bIsUnmoved, inertiaOf(b));
    if (!inertiaA.isMovable() && !inertiaB.isMovable()) return false;

    const Pose poseA = world.motion[a].worldFromBody(), poseB = world.motion[b].worldFromBody();
    const PlacedPair now = placePair(world, pair, poseA, poseB);
    pair.proximity.place(now, pair.tau);
    const std::optional<Touch> deepest = pair.proximity.next();
    if (!deepest || deepest->phi >= 0.0) return false;

    const ContactPoint contact =
        placeContact(world, pair, *deepest, {now, now, now}, inertiaA.inverseInertia,
                     inertiaB.inverseInertia, settings);
    const PassInertia& inertiaS = deepest->sampleOnA ? inertiaA : inertiaB;
    const PassInertia& inertiaF = deepest->sampleOnA ? inertiaB : inertiaA;
    const Mat3 k = collisionMatrix(inertiaS, contact.rS) + collisionMatrix(inertiaF, contact.rF);
    const Eigen::LLT<Mat3> cholesky(k);
    if (cholesky.info() != Eigen::Success) return false;
    const double fraction = static_cast<double>(visit.iteration) / settings.pushOutLevelIterations;
    const Vec3 impulse = cholesky.solve(-fraction * deepest->phi * contact.normal);

    Push ofS = pushFrom(inertiaS, contact.rS, impulse);
    Push ofF = pushFrom(inertiaF, contact.rF, -impulse);
    const double share =
        std::min(inertiaS.isMovable()
                     ? admissibleShare(world.shapeOf(contact.sampleBody), ofS.shift, ofS.turn)
                     : 1.0,
                 inertiaF.isMovable()
                     ? admissibleShare(world.shapeOf(contact.fieldBody), ofF.shift, ofF.turn)
                     : 1.0);
    ++tally.pushes;
    tally.cut += share < 1.0;
    for (Push* push : {&ofS, &ofF}) {
        push->shift *= share;
        push->turn *= share;
    }
    if (inertiaS.isMovable()) move(world.motion[contact.sampleBody], ofS);
    if (inertiaF.isMovable()) move(world.motion[contact.fieldBody], ofF);
    return true;
}

}  // namespace

PushOutTally separateOverlaps(World& world, const ContactGraph& graph, const StepSettings& settings,
                              StepScratch& scratch)
{
    const FrozenBodies frozen(graph.overlap, world.bodyCount());
    const std::vector<PairVisit> visits =
        visitsUpward(graph.overlap, settings.pushOutLevelIterations);
    return visitPairs<PushOutTally>(
        visits, orderOf(world, scratch, visits), scratch,
        [&](const PairVisit& visit, PairRecord& pair, PushOutTally& tally) {
            for (int n = 0; n < settings.pushOutPairImpulses; ++n) {
                if (!pushOnce(world, pair, visit, frozen, settings, tally)) break;
            }
        });
}

WorstOverlap findWorstOverlap(const World& world, StepScratch& scratch)
{
    parallelFor(scratch.pairCount, kPairGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PairRecord& pair = scratch.pairs[i];
            pair.depth = 0.0;
            if (!pair.isTouched) continue;
            pair.proximity.place(placePair(world, pair.bodies), pair.tau);
            if (const auto deepest = pair.proximity.next())
                pair.depth = std::max(0.0, -deepest->phi);
        }
    });
    WorstOverlap worst;
    for (std::size_t i = 0; i < scratch.pairCount; ++i)
        worst.include(world, scratch.pairs[i].bodies, scratch.pairs[i].depth);
    return worst;
}

}  // namespace scree
