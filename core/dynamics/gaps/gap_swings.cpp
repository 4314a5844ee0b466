// Symbols: w spin, r arm from the centre to the contact, u velocity there, n normal.
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
// Where bodies lie on each other going round makes room instead. That is left to the next step. But
// what stands on one corner is held by it whichever way it goes round, and its spin goes round too:
// a top whose corner is told all that nutates for as long as anybody looks, with six steps a frame.
// It lost a hundredth of its energy in a second, all of what kept it up, and fell after two.
// Heaps are left out: their sweeps end long before this is heard, and a thousand rings took up to
// 40 % more of them.
//
// The place of a round contact does not go round with its body but runs over both: half a step
// later the surfaces gain w × d / 2 on each other where its arm changes by d in a step, as it has
// in the last one. Without this half a cylinder that rocks and a plank on a barrel lie deeper after
// a step than their rows ask for, and push-out lifts them by twice the energy of their swing in 20
// s: energy that nobody pays for. To look where the bodies will be instead says the same, and for
// cups and plates contacts took 1.7 times as long.
//
// What swings has velocities of the middle of a step throughout, what does not moves by the mean of
// those before and after it: gap_motion.cpp.
#include "core/dynamics/gaps/gap_swings.h"

#include <algorithm>

#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What is common to two spins.
Vec3 spinOfBoth(const Vec3& a, const Vec3& b)
{
    if (a.dot(b) <= 0.0) return Vec3::Zero();
    return a.squaredNorm() < b.squaredNorm() ? a : b;
}

/// How bodies that turn by these spins leave the straight way where they touch, if the place goes
/// round with each [m/s²].
Vec3 roundAt(const GapRow& row, const Vec3& wA, const Vec3& wB)
{
    return wA.cross(wA.cross(row.rA)) - wB.cross(wB.cross(row.rB));
}

/// How fast the surfaces at a row part half a step later because their bodies turn [m/s], ≤ 0. What
/// slips may go along with either of the two, or with neither, as a smooth wheel does on its axle:
/// what holds for both.
double partingBy(const GapRow& row, const GapBody& a, const GapBody& b, const Vec3& wA,
                 const Vec3& wB, double dt)
{
    const Vec3 round = roundAt(row, wA, wB);
    const Vec3 u = velocityAt(row, a, b), slip = u - u.dot(row.normal) * row.normal;
    const double slipped = std::min(wA.cross(slip).dot(row.normal), wB.cross(slip).dot(row.normal));
    return 0.5 * dt * std::min(round.dot(row.normal) - slipped, 0.0);
}

/// What leaves the straight way by less than this share of what gravity does does not swing: what
/// the solver leaves a block that slides to turn by is far below, and a see-saw that begins to move
/// is above in its second step.
constexpr double kNoSwing = 1e-7;

/// The stronger of what pulls at the two bodies [m/s²].
double pullAt(const GapScratch& scratch, const GapRow& row)
{
    return std::max(scratch.bodies[row.a].pull.norm(), scratch.bodies[row.b].pull.norm());
}

bool isSwing(const GapScratch& scratch, const GapRow& row, double acceleration)
{
    return acceleration > kNoSwing * pullAt(scratch, row);
}

/// As fast as the form of a body turns: what is round about its axis keeps its arms [rad/s].
double shownSpeed(const World& world, BodyId id, const Vec3& w)
{
    return world.shapeOf(id).shownOf(w, world.motion[id].orientation).norm();
}

/// Whether a body has a spin by which the place of a round contact runs over it.
bool showsSpin(const World& world, const GapScratch& scratch, const GapRow& row, BodyId id,
               const Vec3& w)
{
    const double shown = shownSpeed(world, id, w);
    return shown > 0.0 && isSwing(scratch, row, shown * shown * world.shapeOf(id).boundingRadius);
}

/// A place runs over a body by this many times what that turns by, at most; and turns of more than
/// that in a step are too far to be told by their second order [rad].
constexpr double kRunsOn = 2.0, kMostTurn = 0.25;

/// What rocks or rolls is held to its place by what pulls, and gains on it no faster than this many
/// times that. Of splinters that half a tonne rolls over some turn at 400 rad/s; told that the
/// place under it would run on with them, one in thirty threw it up, with twice the energy there
/// was.
constexpr double kMostPulls = 30.0;

/// The rows of a pair that goes on as it did.
class SwingingPair {
public:
    SwingingPair(const World& world, double dt, const GapPair& pair, GapScratch& scratch)
        : world_(world),
          pair_(pair),
          scratch_(scratch),
          dt_(dt),
          before_(std::ranges::equal_range(world.contactMemory.contacts, pair.bodies, {}, bodiesOf))
    {
        // As before impacts: what has just been thrown about goes round nothing.
        const auto spinOf = [&](BodyId body) {
            return angularVelocity(world.motion[body], world.mass[body]);
        };
        wA_ = spinOf(pair.bodies.a);
        wB_ = spinOf(pair.bodies.b);
    }

    /// Of rows that know already where their places will be.
    void noteSwings()
    {
        for (GapRow& row : scratch_.rowsOf(pair_)) row.swings = isShown(row);
    }

    void hold()
    {
        const std::vector<GapContact>& contacts = scratch_.contactsOf(pair_);
        for (std::size_t r = pair_.begin; r < pair_.end; ++r) {
            GapRow& row = scratch_.rows[r];
            const GapContact& contact = contacts[r - pair_.begin];
            const FeatureKind kind = kindOf(contact.feature);
            if (kind == FeatureKind::round)
                holdRound(contact, row);
            else if (pair_.rowCount() == 1 && kind != FeatureKind::edges)
                holdCorner(kind == FeatureKind::cornerOfA ? wB_ : wA_, row);
            else
                holdSharp(row);
        }
    }

private:
    void holdSharp(GapRow& row) const
    {
        if (wA_.isZero(0.0) && wB_.isZero(0.0)) return;
        const Vec3 w = spinOfBoth(wA_, wB_);
        row.target -= partingBy(row, bodyA(), bodyB(), wA_, wB_, dt_);
        row.turning =
            0.5 * dt_ *
            w.cross(w.cross(world_.motion[row.b].position - world_.motion[row.a].position));
        row.target += row.turning.dot(row.normal);
        row.swings = isSwing(scratch_, row, roundAt(row, wA_, wB_).norm());
    }

    /// A corner goes round with its body, and slides on a face that turns by `wOfFace`.
    void holdCorner(const Vec3& wOfFace, GapRow& row) const
    {
        const Vec3 u = velocityAt(row, bodyA(), bodyB());
        const Vec3 slip = u - u.dot(row.normal) * row.normal;
        const Vec3 bySpins =
            spinsUp(bodyA(), row.a, wA_).cross(row.rA) - spinsUp(bodyB(), row.b, wB_).cross(row.rB);
        const Vec3 carried = wOfFace.cross(slip);
        row.turning = 0.5 * dt_ * (roundAt(row, wA_, wB_) + bySpins - carried);
        row.target += 0.5 * dt_ * carried.dot(row.normal);  // the normal turns too
        row.swings = isSwing(scratch_, row, roundAt(row, wA_, wB_).norm());
    }

    /// How the spin of a body changes while its angular momentum stays [rad/s²].
    Vec3 spinsUp(const GapBody& body, BodyId id, const Vec3& w) const
    {
        if (!body.isMovable()) return Vec3::Zero();
        return -(body.inverseInertia * w.cross(world_.motion[id].angularMomentum));
    }

    void holdRound(const GapContact& now, GapRow& row) const
    {
        // In a hollow of facets it goes straight on each, and round all the same.
        const bool isHollow = !shapeA().hollows.isEmpty() || !shapeB().hollows.isEmpty();
        row.swings = isHollow || isShown(row);
        const RememberedContact* before = asBefore(now);
        if (!row.swings || !before) return;
        const Run ran = runSince(*before, now);
        if (isElsewhere(row, ran) || isThrown(row, ran)) return;
        row.turning = ran.turning;
        row.target += std::max(ran.turning.dot(row.normal), 0.0);
    }

    bool isShown(const GapRow& row) const
    {
        return showsSpin(world_, scratch_, row, row.a, wA_) ||
               showsSpin(world_, scratch_, row, row.b, wB_);
    }

    /// How a place has run on.
    struct Run {
        Vec3 overA;    // without what it turned by [m]
        Vec3 turning;  // of a row
    };

    Run runSince(const RememberedContact& before, const GapContact& now) const
    {
        const double dtBefore = world_.contactMemory.dt;
        const BodyMotion &a = world_.motion[pair_.bodies.a], &b = world_.motion[pair_.bodies.b];
        const Vec3 ofA = now.rA - rotated(a.orientation, -dtBefore * wA_) * before.place;
        const Vec3 ofB = ofA + dtBefore * (a.velocity - b.velocity);
        return {ofA - dtBefore * wA_.cross(now.rA),
                0.5 * dt_ / dtBefore * (wA_.cross(ofA) - wB_.cross(ofB))};
    }

    /// The contact of the same features in the last step, the nearest of them; null: none bore.
    const RememberedContact* asBefore(const GapContact& now) const
    {
        const Quat aFromWorld = world_.motion[pair_.bodies.a].orientation.conjugate();
        const Vec3 place = aFromWorld * now.rA;
        const RememberedContact* nearest = nullptr;
        for (const RememberedContact& one : before_) {
            if (one.feature != now.feature) continue;
            if (!nearest ||
                (one.place - place).squaredNorm() < (nearest->place - place).squaredNorm())
                nearest = &one;
        }
        return nearest;
    }

    /// Whether what was there before is not the place that ran on over the bodies: it runs over
    /// neither by more than they roll and slide.
    bool isElsewhere(const GapRow& row, const Run& ran) const
    {
        const Vec3 slid = world_.motion[row.a].velocity + wA_.cross(row.rA) -
                          world_.motion[row.b].velocity - wB_.cross(row.rB);
        const double largest = std::max(shapeA().isPlane ? 0.0 : shapeA().boundingRadius,
                                        shapeB().isPlane ? 0.0 : shapeB().boundingRadius);
        const double most = slid.norm() + kRunsOn * (wA_ - wB_).norm() * largest;
        return ran.overA.norm() > world_.contactMemory.dt * most ||
               dt_ * std::max(shownSpeed(world_, row.a, wA_), shownSpeed(world_, row.b, wB_)) >
                   kMostTurn;
    }

    /// Whether a place runs on faster than anything that pulls could hold it to.
    bool isThrown(const GapRow& row, const Run& ran) const
    {
        return ran.turning.norm() > kMostPulls * dt_ * pullAt(scratch_, row);
    }

    const GapBody& bodyA() const { return scratch_.bodies[pair_.bodies.a]; }
    const GapBody& bodyB() const { return scratch_.bodies[pair_.bodies.b]; }
    const Shape& shapeA() const { return world_.shapeOf(pair_.bodies.a); }
    const Shape& shapeB() const { return world_.shapeOf(pair_.bodies.b); }

    const World& world_;
    const GapPair& pair_;
    GapScratch& scratch_;
    double dt_;
    std::span<const RememberedContact> before_;
    Vec3 wA_, wB_;
};

}  // namespace

void holdSwings(const World& world, double dt, std::span<const VelocityLead> leads,
                const GapBlock& block, GapScratch& scratch)
{
    // By place in the block: ten thousand coins that roll on their rims are led, each by a row.
    std::vector<char> leadsTo(block.bodies.size() + 1, 0);
    for (const VelocityLead& lead : leads) leadsTo[scratch.placeInBlock[lead.body]] = 1;
    const auto isLed = [&](const GapPair& pair) {
        return leadsTo[scratch.placeInBlock[pair.bodies.a]] ||
               leadsTo[scratch.placeInBlock[pair.bodies.b]];
    };
    forIslands(scratch, block, [&](std::size_t i) {
        const GapIsland& island = scratch.islands[i];
        if (isHeap(island)) return;
        for (const std::size_t p : island.pairs) {
            const GapPair& pair = scratch.pairs[p];
            if (!pair.isCarried) continue;
            SwingingPair swinging(world, dt, pair, scratch);
            if (isLed(pair))
                swinging.noteSwings();
            else
                swinging.hold();
        }
    });
}

bool beginsToSwing(const World& world, const GapScratch& scratch, const GapRow& row)
{
    const GapBody &a = scratch.bodies[row.a], &b = scratch.bodies[row.b];
    const Vec3 turnedA = a.spin - a.spinBefore, turnedB = b.spin - b.spinBefore;
    return row.isRound ? showsSpin(world, scratch, row, row.a, turnedA) ||
                             showsSpin(world, scratch, row, row.b, turnedB)
                       : isSwing(scratch, row, roundAt(row, turnedA, turnedB).norm());
}

}  // namespace scree
