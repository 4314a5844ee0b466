// Symbols: r arm from the centre to the contact, n normal, w spin.
//
// A step first changes velocities where bodies are and then moves them by these: velocities are
// those of the middle of a step, impulses act at its beginning. The place where a tilted disc
// touches the ground runs round its rim. Friction that holds the place of the beginning takes
// energy in every step, a tenth of it a second from a disc of 1 m with 4 steps a frame, and coins
// fell flat at once. So what is to be without slip is the place half a step later, and the impulse
// stays where it is: over a step these two cancel, and energy is kept to the second order.
//
// For the same reason the velocity of the step before is right where the place was half a step ago.
// Where it is now the body seems to fall on it: with restitution a coin wobbled higher and higher.
//
// Rims alone: they keep their distance from the centre. Of eggs and lentils that tumble the second
// order is as large as what this would mend, and gained energy.
//
// The solver has one arm for both. What is between them is the same for a body as another velocity,
// as long as it touches nothing else.
#include "core/dynamics/gaps/gap_lead.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/collision/round_contacts.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// A body that turns by less than this in half a step has no lead worth a search [rad].
constexpr double kLeastTurn = 5e-5;

/// A little less of it than there is: what is left of the second order may have either sign, and
/// energy is not to grow. A coin at 20° with 22 steps a frame gains 11 % in 2 s with all of it, and
/// loses 7 % so.
constexpr double kShare = 0.97;

/// How far from the normal a place must be that goes round it, as a share of its arm.
constexpr double kBeside = 1e-3;

/// `vector` turned about n twice as far as an arm has gone round it. Without an angle: sines of the
/// C library have other last bits on other processors.
Vec3 turnedTwice(const Vec3& vector, const Vec3& n, const Vec3& before, const Vec3& after)
{
    const Vec3 from = before - before.dot(n) * n, to = after - after.dot(n) * n;
    const double lengths = from.norm() * to.norm();
    if (std::min(from.norm(), to.norm()) < kBeside * before.norm()) return vector;
    const double cosine = from.dot(to) / lengths, sine = n.dot(from.cross(to)) / lengths;
    const double cosineOfTwice = cosine * cosine - sine * sine, sineOfTwice = 2.0 * sine * cosine;
    return cosineOfTwice * vector + sineOfTwice * n.cross(vector) +
           (1.0 - cosineOfTwice) * n.dot(vector) * n;
}

/// What a body that is touched at r from the direction `outward` lacks of the velocity that it has
/// there, at the place where it is touched `later` [s].
Vec3 leadAt(const Shape& shape, const Quat& worldFromBody, const Vec3& w, const Vec3& r,
            const Vec3& outward, double later)
{
    const Vec3 near = worldFromBody.conjugate() * r;
    const auto armAfter = [&](const Vec3& turn) -> std::optional<Vec3> {
        const Quat turned = rotated(worldFromBody, turn);
        const auto place = placeOnRim(shape, near, turned.conjugate() * outward);
        if (!place) return {};
        return Vec3(turned * *place);
    };
    const std::optional<Vec3> now = armAfter(Vec3::Zero());
    std::optional<Vec3> then = now ? armAfter(later * w) : std::nullopt;
    if (!then) return Vec3::Zero();
    if (later < 0.0) return w.cross(*then - *now);
    // Where the place goes round, the axis of the spin goes with it.
    const Vec3 spin = turnedTwice(w, outward, *now, *then);
    then = armAfter(later * spin);
    return then ? Vec3(kShare * spin.cross(*then - *now)) : Vec3(Vec3::Zero());
}

/// Whether the bodies of a pair touch at one place and one of them is round there.
bool isOneRoundContact(const GapScratch& scratch, const GapPair& pair)
{
    return pair.rowCount() == 1 &&
           kindOf(scratch.contactsOf(pair).front().feature) == FeatureKind::round;
}

/// Of the bodies of those pairs that `isAsked` accepts, and that touch nothing else.
template <class IsAsked>
std::vector<VelocityLead> lead(const World& world, double later, const GapBlock& block,
                               GapScratch& scratch, const IsAsked& isAsked)
{
    std::vector<VelocityLead> leads;
    const auto isMeant = [&](std::size_t i) {
        return isAsked(scratch.pairs[i]) && isOneRoundContact(scratch, scratch.pairs[i]);
    };
    if (std::ranges::none_of(block.pairs, isMeant)) return leads;
    std::vector<int> pairsOf(block.bodies.size() + 1, 0);
    for (const std::size_t i : block.pairs) {
        for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b})
            ++pairsOf[scratch.placeInBlock[body]];
    }
    const auto add = [&](BodyId id, bool moves, const Vec3& r, const Vec3& outward) {
        const GapBody& body = scratch.bodies[id];
        if (!moves || pairsOf[scratch.placeInBlock[id]] > 1) return;
        if (std::abs(later) * body.spin.norm() < kLeastTurn) return;
        const Vec3 change =
            leadAt(world.shapeOf(id), world.motion[id].orientation, body.spin, r, outward, later);
        if (!change.isZero(0.0)) leads.push_back({id, change});
    };
    for (const std::size_t i : block.pairs) {
        if (!isMeant(i)) continue;
        const GapRow& row = scratch.rows[scratch.pairs[i].begin];
        add(row.a, row.movesA, row.rA, -row.normal);
        add(row.b, row.movesB, row.rB, row.normal);
    }
    for (const VelocityLead& one : leads) scratch.bodies[one.body].velocity += one.velocity;
    return leads;
}

}  // namespace

std::vector<VelocityLead> leadPlaces(const World& world, double dt, const GapBlock& block,
                                     GapScratch& scratch)
{
    return lead(world, 0.5 * dt, block, scratch, [](const GapPair&) { return true; });
}

std::vector<VelocityLead> trailPlaces(const World& world, const GapBlock& block,
                                      GapScratch& scratch)
{
    return lead(world, -0.5 * world.contactMemory.dt, block, scratch,
                [](const GapPair& pair) { return pair.isCarried; });
}

void takeBack(const std::vector<VelocityLead>& leads, GapScratch& scratch)
{
    for (const VelocityLead& lead : leads) {
        GapBody& body = scratch.bodies[lead.body];
        body.velocity -= lead.velocity;
        body.velocityBefore -= lead.velocity;
    }
}

}  // namespace scree
