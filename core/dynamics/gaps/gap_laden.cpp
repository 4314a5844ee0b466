// A sweep hands no more momentum through a body than it has itself: of eleven tonnes that roll on
// pebbles of a kilogram four hundred sweeps left so much that the slab, with nothing to drive it,
// went faster and faster, by 380 J in half a second; with four thousand sweeps it did not, nor with
// four times as many steps. What carries that much moves as what it lies between lets it, and its
// own inertia is a hundredth of what it passes on even if it weighs a hundred times more. Nor is it
// flung where it is squeezed out: it leaves at a hundred times the acceleration of gravity, not at
// ten thousand times.
#include "core/dynamics/gaps/gap_laden.h"

#include <algorithm>
#include <limits>

#include "core/dynamics/gaps/gap_forces.h"

namespace scree {
namespace {

/// Of what a body carries it weighs at least so much. With three times the share slabs settle no
/// better.
constexpr double kLeastShare = 0.01;

/// What slips by more than a thousand times what gravity makes of speed in a step flies between
/// others, and is not held: heavier, it would strike them with what it never had. Its share is as
/// much less. Slabs on stones never slip so; with a tenth of this they settle worse.
constexpr double kHeld = 10.0;

/// What its contacts bore of a body in the last step, as impulses of this one [N s].
struct Burden {
    double total = 0.0;
    double inward = 0.0;  // times the arm towards its centre [N s m]
    double slip = 0.0;    // times the speed of the surfaces there against each other [J]

    void add(double impulse, double inwardArm, double speed)
    {
        total += impulse;
        inward += impulse * inwardArm;
        slip += impulse * speed;
    }

    /// Only what is pressed: a link pulled taut swings with the weight that it holds, and would be
    /// heaviest where that is fastest: two tonnes on fifteen links gained twice what they fell by.
    double carried() const { return inward > 0.0 ? 0.5 * total : 0.0; }

    /// The mean, by what they bore [m/s].
    double slipSpeed() const { return slip / total; }
};

/// The most that a body of an island may be taken to carry [kg]. Impulses alone do not tell of
/// weight: rings of mail that is caught as it falls had been laden.
double mostOf(const GapIsland& island, const GapScratch& scratch)
{
    double lightest = std::numeric_limits<double>::infinity(), heaviest = 0.0;
    for (const BodyId body : island.movers) {
        const double mass = 1.0 / scratch.bodies[body].inverseMass;
        lightest = std::min(lightest, mass);
        heaviest = std::max(heaviest, mass);
    }
    return kLeastShare * heaviest > lightest ? heaviest : 0.0;
}

/// Adds what the pairs of an island bore up, by the places of their bodies in the block.
void addBurdens(const GapIsland& island, const GapScratch& scratch, std::vector<Burden>& burdens)
{
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        if (!pair.isCarried) continue;
        Burden& a = burdens[scratch.placeInBlock[pair.bodies.a]];
        Burden& b = burdens[scratch.placeInBlock[pair.bodies.b]];
        for (const GapRow& row : scratch.rowsOf(pair)) {
            const double speed =
                velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]).norm();
            a.add(row.impulse.x(), -row.normal.dot(row.rA), speed);
            b.add(row.impulse.x(), row.normal.dot(row.rB), speed);
        }
    }
}

/// Rows know their bodies' masses.
void prepareLadenRows(const GapIsland& island, GapScratch& scratch)
{
    const auto isLaden = [&](BodyId body) { return scratch.bodies[body].heavier > 1.0; };
    for (const std::size_t i : island.pairs) {
        const GapPair& pair = scratch.pairs[i];
        if (!isLaden(pair.bodies.a) && !isLaden(pair.bodies.b)) continue;
        for (std::size_t r = pair.begin; r < pair.end; ++r)
            prepareRow(scratch.bodies, scratch.rows[r]);
    }
}

}  // namespace

LadenBodies::LadenBodies(double dt, const GapBlock& block, GapScratch& scratch) : scratch_(scratch)
{
    std::vector<Burden> burdens;
    for (const std::size_t i : block.islands) {
        const GapIsland& island = scratch.islands[i];
        const double most = mostOf(island, scratch);
        const double fall = dt * strongestPull(scratch, island);
        if (most == 0.0 || fall == 0.0) continue;
        burdens.resize(block.bodies.size() + 1);
        addBurdens(island, scratch, burdens);
        const std::size_t before = laden_.size();
        for (const BodyId id : island.movers) {
            GapBody& body = scratch.bodies[id];
            const Burden& burden = burdens[scratch.placeInBlock[id]];
            const double carried = std::min(burden.carried() / fall, most);
            if (carried == 0.0) continue;
            const double share = std::min(kLeastShare, kHeld * fall / burden.slipSpeed());
            body.heavier = std::max(1.0, share * carried * body.inverseMass);
            if (body.heavier == 1.0) continue;
            laden_.push_back({id, body.inverseMass, body.inverseInertia});
            body.inverseMass /= body.heavier;
            body.inverseInertia /= body.heavier;
        }
        if (laden_.size() > before) prepareLadenRows(island, scratch);
    }
}

void LadenBodies::release()
{
    for (const Laden& laden : laden_) {
        scratch_.bodies[laden.body].inverseMass = laden.inverseMass;
        scratch_.bodies[laden.body].inverseInertia = laden.inverseInertia;
    }
    laden_.clear();
}

}  // namespace scree
