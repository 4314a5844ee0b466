#include "core/dynamics/gaps/gap_pushes.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/push_limits.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

void push(PushedBody& body, const Vec3& r, const Vec3& impulse)
{
    body.shift += body.inverseMass * impulse;
    body.turn += body.inverseInertia * r.cross(impulse);
    body.isPushed = true;
}

/// Answers the change of the separation [m].
double visit(PushRow& row, double give, std::vector<PushedBody>& bodies)
{
    PushedBody &a = bodies[row.a], &b = bodies[row.b];
    if (row.wanted <= 0.0 && !a.isPushed && !b.isPushed) return 0.0;
    const double separation =
        row.normal.dot(a.shift + a.turn.cross(row.rA) - b.shift - b.turn.cross(row.rB));
    const double k = row.inverseMass;
    const double missing = row.wanted - separation - give * k * row.impulse;
    const double before = row.impulse;
    row.impulse = std::max(0.0, before + missing / (k * (1.0 + give)));
    if (row.impulse == before) return 0.0;
    const Vec3 change = (row.impulse - before) * row.normal;
    if (row.movesA) push(a, row.rA, change);
    if (row.movesB) push(b, row.rB, -change);
    return k * std::abs(row.impulse - before);
}

}  // namespace

double excessOf(const World& world, const GapRow& row, double gap, double left)
{
    return -gap - left * smallerRadius(world, row.a, row.b);
}

void takeUp(const GapBody& body, double lighter, PushedBody& pushed)
{
    pushed.inverseMass = lighter * body.inverseMass;
    pushed.inverseInertia = lighter * body.inverseInertia;
}

PushRow pushRow(const GapRow& row, double wanted, const std::vector<PushedBody>& bodies)
{
    const auto part = [&](BodyId id, const Vec3& r) {
        const Vec3 arm = r.cross(row.normal);
        return bodies[id].inverseMass + arm.dot(bodies[id].inverseInertia * arm);
    };
    PushRow push{row.a, row.b, row.movesA, row.movesB, row.rA, row.rB, row.normal, 0.0, wanted};
    if (row.movesA) push.inverseMass += part(row.a, row.rA);
    if (row.movesB) push.inverseMass += part(row.b, row.rB);
    return push;
}

double sweep(std::vector<PushRow>& rows, double give, std::vector<PushedBody>& bodies)
{
    double largest = 0.0;
    for (PushRow& row : rows) largest = std::max(largest, visit(row, give, bodies));
    return largest;
}

double sweep(std::vector<PushRow>& rows, std::span<const std::size_t> some, double give,
             std::vector<PushedBody>& bodies)
{
    double largest = 0.0;
    for (const std::size_t i : some) largest = std::max(largest, visit(rows[i], give, bodies));
    return largest;
}

bool displace(World& world, BodyId id, const PushedBody& pushed)
{
    const double share = admissibleShare(world.shapeOf(id), pushed.shift, pushed.turn);
    BodyMotion& motion = world.motion[id];
    motion.position += share * pushed.shift;
    motion.orientation = rotated(motion.orientation, share * pushed.turn);
    return share < 1.0;
}

}  // namespace scree
