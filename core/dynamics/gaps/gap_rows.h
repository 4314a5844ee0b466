// The contacts of one step of method `scree` as rows of one problem, and the bodies as its
// unknowns.  [algorithm 14.1]
//
// A row is what all phases know of a contact. Sweeps over many have a layout of their own
// (gap_lanes.h), so that a heap of a thousand rings stays in the second-level cache.
#pragma once

#include <algorithm>
#include <vector>

#include "core/collision/contact_with_gap.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

struct GapBlock;
struct GapScratch;

/// A body as the solver sees it. Velocities are those of the phase that runs. What is looked at
/// most comes first, in two cache lines.
struct alignas(64) GapBody {
    Vec3 velocity, spin;  ///< [m/s], [rad/s]
    Vec3 shift, turn;     ///< added to the motion of this step: not everything moves for all of it
                          ///< with its final velocity [m], [rad]
    Vec3 pull;            ///< that acts throughout the step [m/s²]
    double inverseMass;   ///< [1/kg]; 0: cannot be moved
    Mat3 inverseInertia;  ///< world
    Vec3 torque;          ///< that acts throughout the step [N m]
    Vec3 velocityBefore, spinBefore;  ///< before pull and torque acted
    Vec3 angularImpulse;              ///< of the step, without what the rows keep [kg m²/s]
    double hitAt;    ///< until when it moves as before an impact [s]; 0: none struck it, or one at
                     ///< once, or what it moved before has been taken back
    double heavier;  ///< times it weighs its mass while contacts are solved: gap_laden.h; ≥ 1
    bool isHeld;     ///< something bore it in the last step
    bool isStopped;  ///< something may stop it within the step
    bool isKept;     ///< as an earlier attempt at the step has solved it

    bool isMovable() const { return inverseMass > 0.0; }
};

struct GapRow {
    BodyId a, b;
    bool movesA, movesB;  ///< whether its impulses act on the body: not on what cannot be moved,
                          ///< nor on one that the other's group does not move
    bool isUnmovedA, isUnmovedB;   ///< by its group
    bool wasHit;                   ///< by an impact of this step
    bool isOfBlow;                 ///< has the arms and the normal of the moment it is hit
    bool isRound;                  ///< its place belongs to no body
    bool isOfBalls;                ///< goes through both centres, wherever they meet
    bool swings;                   ///< its place leaves the straight way: gap_swings.h
    Vec3 rA, rB;                   ///< contact point from either centre, world [m]
    Vec3 normal;                   ///< from B to A
    double gap;                    ///< [m]
    Vec3 turning;                  ///< what A's surface gains on B's within half the step as both
                                   ///< go round: gap_swings.h [m/s]
    Vec3 impulse;                  ///< along normal, tangent and second tangent, on A [N s]
    double squeeze;                ///< what presses it besides, for friction alone: gap_grip.h
                                   ///< [N s]
    Vec3 tangent;                  ///< the second tangent is normal × tangent
    double friction, restitution;  ///< [-]
    double target;  ///< normal velocity that closes the gap within the step [m/s], ≤ 0; of
                    ///< an impact, with which it rebounds
    double inverseNormalMass;        ///< normal velocity by a unit normal impulse [1/kg]
    double frictionMass[3];          ///< inverse of the tangential 2×2 block: tt, ts, ss [kg]
    double slideMass;                ///< 1 / largest eigenvalue of that block [kg]
    double normalIntoFriction[2];    ///< tangential velocities by a unit normal impulse [1/kg]
    double rollingArm, spinningArm;  ///< lever arms of the resistance to rolling and spinning [m]
    double rollResponse;             ///< spin across the normal by a unit couple while friction
                                     ///< holds the place, at most [1/(kg m²)]
    Vec3 couple;                     ///< of that resistance, on A, world [N m s]

    /// Without an impulse along the normal only what is squeezed does.
    bool carries() const { return !impulse.isZero(0.0); }
    /// What friction may be, at most [N s].
    double frictionLimit() const { return friction * (impulse.x() + squeeze); }
    bool resistsSpin() const { return rollingArm > 0.0 || spinningArm > 0.0; }
    Vec3 secondTangent() const { return normal.cross(tangent); }
    Vec3 worldImpulse() const
    {
        return impulse.x() * normal + impulse.y() * tangent + impulse.z() * secondTangent();
    }
};

/// Fills the rows of a block from the contacts of its pairs, with the impulses that the world
/// remembers. Keyed bodies must have been aimed.
void buildRows(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
               GapScratch& scratch);

/// Cannot be moved by impulses, and moves.
inline bool isDriven(const GapBody& body)
{
    return !body.isMovable() && !(body.velocity.isZero(0.0) && body.spin.isZero(0.0));
}

/// Friction beyond this share of its limit slides: sliding is solved to rounding.
inline constexpr double kSlides = 1.0 - 1e-9;

/// Whether friction holds the place of a row.
inline bool sticks(const GapRow& row)
{
    const double limit = kSlides * row.frictionLimit();
    return row.impulse.y() * row.impulse.y() + row.impulse.z() * row.impulse.z() < limit * limit;
}

/// Relative velocity of the two surfaces at a row, A's against B's [m/s].
inline Vec3 velocityAt(const GapRow& row, const GapBody& a, const GapBody& b)
{
    return a.velocity + a.spin.cross(row.rA) - b.velocity - b.spin.cross(row.rB) + row.turning;
}

/// What the shifts of the two bodies add to the gap [m].
inline double shiftAt(const GapRow& row, const GapBody& a, const GapBody& b)
{
    return row.normal.dot(a.shift + a.turn.cross(row.rA) - b.shift - b.turn.cross(row.rB));
}

/// The bodies of a row, and where they touch; bFromA: the centre of A from that of B, world [m].
inline void placeRow(BodyPair bodies, const GapContact& contact, const Vec3& bFromA, GapRow& row)
{
    row.a = bodies.a;
    row.b = bodies.b;
    row.rA = contact.rA;
    row.rB = contact.rA + bFromA;
    row.normal = contact.normal;
    row.gap = contact.gap;
    row.turning = Vec3::Zero();
    row.isRound = kindOf(contact.feature) == FeatureKind::round;
    row.swings = false;
}

/// Everything of a row that follows from its geometry.
void prepareRow(const std::vector<GapBody>& bodies, GapRow& row);

/// How far apart the surfaces at a row would be at the end of the step if the bodies had no
/// velocity [m].
inline double openAt(const GapRow& row, const GapBody& a, const GapBody& b)
{
    return std::max(row.gap, 0.0) + shiftAt(row, a, b);
}

/// How far a row is from the centres of what it moves, at most: with no body that it does not, be
/// it a floor whose origin is a mile away, has its spin to do [m].
inline double leverOf(const GapRow& row)
{
    return std::max(row.movesA ? row.rA.norm() : 0.0, row.movesB ? row.rB.norm() : 0.0);
}

/// How easily a row turns a body, about one axis or another [1/(kg m²)].
inline double easeOfTurning(const GapBody& body, bool moves)
{
    return moves ? body.inverseInertia.trace() : 0.0;
}

/// What the impulses of a row see of a body.
inline PassInertia inertiaOf(const GapBody& body, bool moves)
{
    return moves ? PassInertia{body.inverseMass, body.inverseInertia} : PassInertia{};
}

/// How a couple between the bodies changes their relative spin [1/(kg m²)].
inline Mat3 coupleResponse(const GapRow& row, const GapBody& a, const GapBody& b)
{
    Mat3 response = Mat3::Zero();
    if (row.movesA) response += a.inverseInertia;
    if (row.movesB) response += b.inverseInertia;
    return response;
}

inline void applyTo(GapBody& body, const Vec3& r, const Vec3& impulse)
{
    body.velocity += body.inverseMass * impulse;
    body.spin += body.inverseInertia * r.cross(impulse);
}

inline void applyCoupleTo(GapBody& body, const Vec3& couple)
{
    body.spin += body.inverseInertia * couple;
}

}  // namespace scree
