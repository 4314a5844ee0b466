// Symbols: u normal velocity (approaching < 0), t time since the step began.
#include "core/dynamics/gaps/gap_foresight.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/dynamics/body_pairs.h"
#include "core/dynamics/gaps/pair_foresight.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What comes closer by less than this share of the smaller body in a step stops at nothing.
constexpr double kSlow = 1e-4;

/// What passes is let through by so much more than it takes: by rounding it would seem to bear.
constexpr double kSpare = 1e-6;

/// By how much a row is closed at the end of the step, where nothing else happens [m].
double closedBy(const GapScratch& scratch, const GapRow& row, double u, double dt)
{
    const double g = (scratch.bodies[row.a].pull - scratch.bodies[row.b].pull).dot(row.normal);
    return -(std::max(row.gap, 0.0) + dt * (u + 0.5 * g * dt));
}

/// What becomes of a pair in the step.
struct Foreseen {
    bool passes = false;
    double fastEnough = 0.0;
    double blowAt = kNotKnown;  // [s]
};

double closingSpeed(const GapScratch& scratch, const GapRow& row)
{
    return -velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]).dot(row.normal);
}

Foreseen foresee(const World& world, double dt, const std::vector<Held>& held, const GapPair& pair,
                 GapScratch& scratch)
{
    const double slow = kSlow * smallerRadius(world, pair.bodies.a, pair.bodies.b) / dt;
    double fastest = slow;
    const auto rows = scratch.rowsOf(pair);
    for (const GapRow& row : rows) {
        if (bears(row)) continue;
        const double closing = closingSpeed(scratch, row);
        if (closing > fastest && closedBy(scratch, row, -closing, dt) > 0.0) fastest = closing;
    }
    if (fastest == slow) return {};
    thread_local std::vector<GapContact> room;
    PairForesight foresight(world, held, scratch, pair, dt, fastest, room);
    const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
    // A plane is everywhere ahead of what comes down on it.
    const bool mayPass = !world.shapeOf(pair.bodies.a).isPlane &&
                         !world.shapeOf(pair.bodies.b).isPlane &&
                         !std::ranges::binary_search(scratch.unseen.diverted, pair.bodies);
    if (mayPass && foresight.passes(contacts)) return {true, foresight.fastEnough()};
    return {false, 0.0, foresight.aim(contacts, rows)};
}

/// Per place of a body in the block: the first moment at which it is known to be struck, or the end
/// of the step.
std::vector<double> momentsOfBlows(double dt, const std::vector<Foreseen>& foreseen,
                                   const GapBlock& block, const GapScratch& scratch)
{
    std::vector<double> struckAt(block.bodies.size() + 1, dt);
    for (const std::size_t i : block.pairs) {
        const GapPair& pair = scratch.pairs[i];
        const double t = foreseen[pair.place].blowAt;
        if (t == kNotKnown) continue;
        for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
            double& first = struckAt[scratch.placeInBlock[body]];
            first = std::min(first, t);
        }
    }
    return struckAt;
}

/// Gives a body that flies freely the spin and the inertia of a moment of the step: what strikes it
/// then finds it turned.
void turnUntil(const World& world, const StepSettings& settings, double t, BodyId id, GapBody& body)
{
    const BodyMotion& motion = world.motion[id];
    const Pose then = predictPose(motion, world.mass[id], motion.velocity, motion.angularMomentum,
                                  settings.orientation, t);
    body.inverseInertia =
        inverseInertiaWorld(then.orientation.toRotationMatrix(), world.mass[id].inverseInertia);
    body.spin = body.inverseInertia * motion.angularMomentum;
}

/// Gives the rows of a pair what their bodies are now, and the gaps that close when they are hit.
void settleRows(double dt, const std::vector<Held>& held, const GapPair& pair, const Foreseen& seen,
                GapScratch& scratch)
{
    const auto pullOn = [&](BodyId body) {
        return Vec3(scratch.bodies[body].pull + held[scratch.placeInBlock[body]].acceleration);
    };
    const Vec3 pull = pullOn(pair.bodies.a) - pullOn(pair.bodies.b);
    for (GapRow& row : scratch.rowsOf(pair)) {
        prepareRow(scratch.bodies, row);
        const double closing = closingSpeed(scratch, row);
        if (row.isOfBlow) {
            row.gap = std::max(row.gap, 0.0) +
                      seen.blowAt * (closing - 0.5 * pull.dot(row.normal) * seen.blowAt);
        } else if (seen.passes && !bears(row) && closing > seen.fastEnough) {
            const double closed = std::max(closedBy(scratch, row, -closing, dt), 0.0);
            row.gap = std::max(row.gap, 0.0) + (1.0 + kSpare) * closed;
        }
    }
}

/// Brings the arms of a row, of a moment at which its bodies were elsewhere, to one place: that of
/// each changes the more the harder it is to turn, as in gap_motion.cpp.
void bringTogether(const World& world, const std::vector<GapBody>& bodies, GapRow& row)
{
    const Vec3 bFromA = world.motion[row.a].position - world.motion[row.b].position;
    const Vec3 slid = bFromA - (row.rB - row.rA);
    const double easeA = easeOfTurning(bodies[row.a], row.movesA);
    const double easeB = easeOfTurning(bodies[row.b], row.movesB);
    if (easeA + easeB > 0.0) row.rA -= easeB / (easeA + easeB) * slid;
    row.rB = row.rA + bFromA;
    prepareRow(bodies, row);
}

}  // namespace

void foreseeBlows(const World& world, const StepSettings& settings, double dt,
                  const std::vector<Held>& held, const GapBlock& block, GapScratch& scratch)
{
    std::vector<Foreseen> foreseen(block.pairs.size());
    forPairs(block, [&](std::size_t i) {
        GapPair& pair = scratch.pairs[i];
        const Foreseen& seen = foreseen[pair.place] = foresee(world, dt, held, pair, scratch);
        pair.isLetPass = seen.passes;
    });
    const std::vector<double> struckAt = momentsOfBlows(dt, foreseen, block, scratch);
    std::vector<char> isTurned(block.bodies.size() + 1, 0);
    forEach(block.bodies.size(), kShortWork, [&](std::size_t n) {
        const BodyId id = block.bodies[n];
        GapBody& body = scratch.bodies[id];
        const double t = struckAt[n + 1];
        if (t >= dt || t * body.spin.norm() <= kTurnsOn) return;
        if (!held[n + 1].acceleration.isZero(0.0) || !held[n + 1].turning.isZero(0.0)) return;
        turnUntil(world, settings, t, id, body);
        isTurned[n + 1] = 1;
    });
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        const Foreseen& seen = foreseen[pair.place];
        if (seen.passes || seen.blowAt != kNotKnown ||
            isTurned[scratch.placeInBlock[pair.bodies.a]] ||
            isTurned[scratch.placeInBlock[pair.bodies.b]])
            settleRows(dt, held, pair, seen, scratch);
    });
}

void forgetMomentsOfBlows(const World& world, const GapBlock& block, GapScratch& scratch)
{
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        for (GapRow& row : scratch.rowsOf(pair)) {
            if (!std::exchange(row.isOfBlow, false)) continue;
            bringTogether(world, scratch.bodies, row);
        }
    });
}

}  // namespace scree
