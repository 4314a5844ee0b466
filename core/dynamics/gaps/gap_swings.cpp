// Symbols: w spin, r arm from the centre to the contact, u velocity there.
//
// A step moves bodies along velocities that are those of its middle. A place that goes round with
// its body is drawn towards the centre by w × (w × r) dt²/2 meanwhile, and where the body hangs by
// that place this opens what a straight way keeps closed: a bob goes along the tangent and is then
// pulled back, by the push-out. Where the row asks for what the place will lack, its impulse stands
// between the velocities of half a step before and after, and does no work. A ball of two tons on a
// chain of eleven links loses a quarter of its energy in 10 s, most of it to friction, where it
// lost near half; a ring in a ring loses half of what it did. To ask for twice as much opens
// contacts.
//
// What lies on a disc that turns crept outwards by the same, a tenth of a metre in 8 s at half a
// metre from the middle and 20 turns a minute, and the disc lost a twentieth of its spin. Of two
// bodies that turn alike all places gain the same on each other, so friction may be told too.
//
// Where bodies lie on each other going round makes room instead. That is left to the next step. Of
// round contacts the place does not go round with its body (gap_lead.h). Heaps are left out: their
// sweeps end long before this is heard, and a thousand rings took up to 40 % more of them.
#include "core/dynamics/gaps/gap_swings.h"

#include <algorithm>

#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/integrator.h"

namespace scree {
namespace {

/// What is common to two spins.
Vec3 spinOfBoth(const Vec3& a, const Vec3& b)
{
    if (a.dot(b) <= 0.0) return Vec3::Zero();
    return a.squaredNorm() < b.squaredNorm() ? a : b;
}

/// How fast the surfaces at a row part half a step later because their bodies turn [m/s], ≤ 0. What
/// slips may go along with either of the two, or with neither, as a smooth wheel does on its axle:
/// what holds for both.
double partingBy(const GapRow& row, const GapBody& a, const GapBody& b, const Vec3& wA,
                 const Vec3& wB, double dt)
{
    const Vec3 round = wA.cross(wA.cross(row.rA)) - wB.cross(wB.cross(row.rB));
    const Vec3 u = velocityAt(row, a, b), slip = u - u.dot(row.normal) * row.normal;
    const double slipped = std::min(wA.cross(slip).dot(row.normal), wB.cross(slip).dot(row.normal));
    return 0.5 * dt * std::min(round.dot(row.normal) - slipped, 0.0);
}

void holdPair(const World& world, double dt, const GapPair& pair, GapScratch& scratch)
{
    if (!pair.isCarried) return;
    const auto spinOf = [&](BodyId body) {
        return angularVelocity(world.motion[body], world.mass[body]);
    };
    // As before impacts: what has just been thrown about goes round nothing.
    const Vec3 wA = spinOf(pair.bodies.a), wB = spinOf(pair.bodies.b);
    if (wA.isZero(0.0) && wB.isZero(0.0)) return;
    const GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
    const Vec3 w = spinOfBoth(wA, wB);
    const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
    for (std::size_t r = pair.begin; r < pair.end; ++r) {
        GapRow& row = scratch.rows[r];
        if (kindOf(contacts[r - pair.begin].feature) != FeatureKind::round)
            row.target -= partingBy(row, a, b, wA, wB, dt);
        row.turning = 0.5 * dt * w.cross(w.cross(row.rA - row.rB));
        row.target += row.turning.dot(row.normal);
    }
}

}  // namespace

void holdSwings(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                GapScratch& scratch)
{
    forIslands(scratch, block, [&](std::size_t i) {
        const GapIsland& island = scratch.islands[i];
        if (isHeap(settings, island)) return;
        for (const std::size_t p : island.pairs) holdPair(world, dt, scratch.pairs[p], scratch);
    });
}

}  // namespace scree
