// Symbols: gap_rows.h; U speed of keyed surfaces along the normals of their contacts.
//
// Sweeps over a contradiction add about m U to every impulse each time, and the next step begins
// with what this one found. Two balls in a straight line under a plate that came down at 1 m/s
// carried three million times their momentum after a hundred steps, and friction and the last bit
// of their direction threw them at 700 m/s. A cap of their speeds did not hold: what was left grew
// again in every step.
#include "core/dynamics/gaps/gap_press.h"

#include <algorithm>
#include <cmath>

#include "core/base/sorted.h"
#include "core/dynamics/gaps/gap_forces.h"
#include "core/dynamics/gaps/gap_visit.h"

namespace scree {
namespace {

/// Impulses of what presses beyond this many times the momentum of the island at their speed
/// contradict each other. They are counted along their normals: what a wedge drives before it takes
/// four times its momentum where the flank is 75° off the way.
constexpr double kPressed = 4.0;

/// What may be left of U when sweeps end, where they agree.
constexpr double kStillCloses = 0.01;

/// The share of U by which what presses runs into what it merely pushes along: each of its n
/// contacts with a mass m carries m U / n then. More than may be left of U without a contradiction.
constexpr double kYield = 0.02;
constexpr int kMostSweeps = 200;
constexpr double kEnough = 1e-3;  // of U

/// What presses an island whatever it meets there: keyed bodies, and those that are not moved by
/// what they press. A slab of four tons of that kind threw the cubes it fell on at 200 m/s.
struct Press {
    double speed = 0.0;       // U, the largest [m/s]
    double impulse = 0.0;     // the sum of theirs along the normals [N s]
    int rows = 0;             // that have one
    double massOfRest = 0.0;  // of what they press [kg]
};

/// Whether a body of a pair moves, and not by the impulses of that.
bool presses(const GapBody& body, bool isUnmoved)
{
    return isDriven(body) || (isUnmoved && body.isMovable());
}

Press pressOn(const GapScratch& scratch, const GapIsland& island)
{
    Press press;
    thread_local std::vector<BodyId> movable;  // that press
    movable.clear();
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        const auto rows = scratch.rowsOf(pair);
        if (rows.empty()) continue;
        const GapBody &a = scratch.bodies[pair.bodies.a], &b = scratch.bodies[pair.bodies.b];
        const bool isByA = presses(a, rows.front().isUnmovedA);
        if (!isByA && !presses(b, rows.front().isUnmovedB)) continue;
        if ((isByA ? a : b).isMovable()) movable.push_back(isByA ? pair.bodies.a : pair.bodies.b);
        for (const GapRow& row : rows) {
            if (row.impulse.x() == 0.0) continue;
            const Vec3 u = isByA ? Vec3(a.velocity + a.spin.cross(row.rA))
                                 : Vec3(b.velocity + b.spin.cross(row.rB));
            press.speed = std::max(press.speed, std::abs(u.dot(row.normal)));
            press.impulse += row.impulse.x();
            ++press.rows;
        }
    }
    sortUnique(movable);
    for (const BodyId body : island.movers) {
        if (!std::ranges::binary_search(movable, body))
            press.massOfRest += 1.0 / scratch.bodies[body].inverseMass;
    }
    return press;
}

/// visitRow() of a contact that closes by `yield` for each unit of its impulse [1/kg].
double visitYielding(double yield, GapRow& row, GapScratch& scratch)
{
    const double target = row.target, response = row.inverseNormalMass;
    row.target -= yield * row.impulse.x();
    row.inverseNormalMass += yield;
    const double changed = visitRow(row, scratch.bodies[row.a], scratch.bodies[row.b]);
    row.target = target;
    row.inverseNormalMass = response;
    return changed;
}

}  // namespace

bool isPressed(double dt, const GapScratch& scratch, const GapIsland& island)
{
    const Press press = pressOn(scratch, island);
    if (press.speed == 0.0 || press.massOfRest == 0.0) return false;
    const double momentum = press.massOfRest * (press.speed + dt * strongestPull(scratch, island));
    if (press.impulse <= kPressed * momentum) return false;
    double closing = 0.0;
    forRows(scratch, island.pairs, [&](std::size_t r) {
        const GapRow& row = scratch.rows[r];
        const Vec3 u = velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]);
        closing = std::max(closing, row.target - u.dot(row.normal));
    });
    return closing > kStillCloses * press.speed;
}

void solvePressed(double dt, const GapIsland& island, GapScratch& scratch)
{
    const Press press = pressOn(scratch, island);
    const double yield = kYield * press.rows / press.massOfRest;
    for (const BodyId mover : island.movers) {
        GapBody& body = scratch.bodies[mover];
        body.velocity = body.velocityBefore + dt * body.pull;
        body.spin = body.spinBefore + dt * body.heavier * (body.inverseInertia * body.torque);
    }
    forRows(scratch, island.pairs, [&](std::size_t r) {
        scratch.rows[r].impulse = scratch.rows[r].couple = Vec3::Zero();
    });
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double residual = 0.0;
        forRows(scratch, island.pairs, [&](std::size_t r) {
            residual = std::max(residual, visitYielding(yield, scratch.rows[r], scratch));
        });
        if (residual <= kEnough * press.speed) break;
    }
}

}  // namespace scree
