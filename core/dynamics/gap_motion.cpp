#include "core/dynamics/gap_motion.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Overlap that is left alone, as a share of the smaller body: removing all of it shook stacks.
constexpr double kSlop = 1e-4;
/// Share of the rest that one step removes.
constexpr double kShare = 0.2;
constexpr int kSweeps = 8;

}  // namespace

void writeVelocities(World& world, double dt, const GapScratch& scratch)
{
    const auto isStepped = [&](BodyId body) { return scratch.bodies[body].inverseMass > 0.0; };
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        if (!isStepped(static_cast<BodyId>(i))) continue;
        world.motion[i].velocity = scratch.bodies[i].velocity;
        world.motion[i].angularMomentum += scratch.bodies[i].angularImpulse;
    }
    // What holds sleepers is remembered for when they wake.
    std::vector<RememberedContact> kept;
    kept.reserve(world.contactMemory.contacts.size() + scratch.rows.size());
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        const bool sleeps =
            world.contactMemory.isAsleep(contact.a) || world.contactMemory.isAsleep(contact.b);
        if (sleeps && !isStepped(contact.a) && !isStepped(contact.b)) kept.push_back(contact);
    }
    const auto ofSleepers = static_cast<std::ptrdiff_t>(kept.size());
    for (const GapPair& pair : scratch.pairs) {
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            const GapRow& row = scratch.rows[r];
            if (row.impulse.x() == 0.0) continue;
            const Vec3 impulse = row.worldImpulse();
            // What changes the angular momentum is the impulse itself: a product with an inertia
            // and its inverse would lose bits every step.
            if (row.movesA)
                world.motion[row.a].angularMomentum += row.rA.cross(impulse) + row.couple;
            if (row.movesB)
                world.motion[row.b].angularMomentum -= row.rB.cross(impulse) + row.couple;
            const Quat aFromWorld = world.motion[row.a].orientation.conjugate();
            kept.push_back({row.a, row.b, pair.contacts[r - pair.begin].feature,
                            aFromWorld * row.rA, impulse / dt});
        }
    }
    // Both parts are sorted: the memory is, and so are the pairs.
    std::inplace_merge(kept.begin(), kept.begin() + ofSleepers, kept.end(),
                       [](const RememberedContact& p, const RememberedContact& q) {
                           return p.a < q.a || (p.a == q.a && p.b < q.b);
                       });
    world.contactMemory.contacts = std::move(kept);
    world.contactMemory.dt = dt;
}

void moveBodies(World& world, const StepSettings& settings, double dt, GapScratch& scratch)
{
    advancePositions(world, settings, dt);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        BodyMotion& motion = world.motion[i];
        GapBody& body = scratch.bodies[i];
        if (body.inverseMass > 0.0) {
            motion.position += body.shift;
            motion.orientation = rotated(motion.orientation, body.turn);
        }
        // From here on the shift is the whole displacement: what the rows need for their gaps.
        body.shift += dt * motion.velocity;
        body.turn += dt * body.spin;
    }
}

std::int64_t separateGaps(World& world, GapScratch& scratch)
{
    struct Push {
        const GapRow* row;
        double wanted, impulse;
    };
    std::vector<Push> pushes;
    for (const std::size_t i : scratch.order) {
        for (std::size_t r = scratch.pairs[i].begin; r < scratch.pairs[i].end; ++r) {
            const GapRow& row = scratch.rows[r];
            const double gap = row.gap + shiftAt(row, scratch.bodies[row.a], scratch.bodies[row.b]);
            const double excess = -gap - kSlop * smallerRadius(world, row.a, row.b);
            if (excess > 0.0) pushes.push_back({&row, kShare * excess, 0.0});
        }
    }
    if (pushes.empty()) return 0;
    for (GapBody& body : scratch.bodies) body.shift = body.turn = Vec3::Zero();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (Push& push : pushes) {
            const GapRow& row = *push.row;
            GapBody& a = scratch.bodies[row.a];
            GapBody& b = scratch.bodies[row.b];
            const double impulse = std::max(
                0.0, push.impulse + (push.wanted - shiftAt(row, a, b)) / row.inverseNormalMass);
            const Vec3 change = (impulse - push.impulse) * row.normal;
            push.impulse = impulse;
            if (row.movesA) {
                a.shift += a.inverseMass * change;
                a.turn += a.inverseInertia * row.rA.cross(change);
            }
            if (row.movesB) {
                b.shift -= b.inverseMass * change;
                b.turn -= b.inverseInertia * row.rB.cross(change);
            }
        }
    }
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const GapBody& body = scratch.bodies[i];
        if (body.inverseMass == 0.0) continue;
        if (body.shift.isZero(0.0) && body.turn.isZero(0.0)) continue;
        world.motion[i].position += body.shift;
        world.motion[i].orientation = rotated(world.motion[i].orientation, body.turn);
    }
    return static_cast<std::int64_t>(pushes.size());
}

}  // namespace scree
