// Both passes solve one level at a time beside bodies that are pinned: those of other levels, which
// are held as if they could not give way.
#include "core/dynamics/gaps/gap_shock.h"

#include <algorithm>
#include <span>

#include "core/base/groups.h"
#include "core/base/parallel.h"
#include "core/base/sorted.h"
#include "core/dynamics/gaps/gap_contact.h"
#include "core/dynamics/gaps/gap_forces.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_pairs.h"
#include "core/dynamics/gaps/gap_visit.h"

namespace scree {
namespace {

/// Sweeps up and down over the rows of one level, at most; its rows are few and near each other.
/// Weights are handed down once: a block on a slope that begins without friction needs 30 to 60
/// of them to lie still to nine digits.
constexpr int kShockSweeps = 30, kWeightSweeps = 100;

/// A row that closes this share of the smaller body past zero in a step calls for shock: where the
/// sweeps could have solved the problem to the end, and where they had to stop.
constexpr double kVisibleWhenSolved = 1e-5, kVisibleInHeaps = 1e-3;
/// What a level of shock may leave of that, as a share.
constexpr double kWellBelow = 0.1;

/// What bears so many times all that there is of weight bears none. Half a tonne that rolled onto
/// two splinters of two grams, both pinned, jammed between them; handed that, they had 1e7 m/s, and
/// threw it up at 55 m/s.
constexpr double kMostOfWeight = 10.0;

/// The bodies of a level's rows that its solve must not move, as they were.
class PinnedBodies {
public:
    explicit PinnedBodies(GapScratch& scratch) : scratch_(scratch) {}
    /// What cannot be moved, or no more, needs no pin; other threads look at it too.
    void pin(BodyId body)
    {
        GapBody& b = scratch_.bodies[body];
        if (!b.isMovable()) return;
        pinned_.push_back({body, b});
        b.inverseMass = 0.0;
        b.inverseInertia.setZero();
    }
    void release()
    {
        for (const Pinned& pinned : pinned_) scratch_.bodies[pinned.body] = pinned.before;
        pinned_.clear();
    }

private:
    struct Pinned {
        BodyId body;
        GapBody before;
    };
    GapScratch& scratch_;
    std::vector<Pinned> pinned_;
};

/// The motion that bodies had before a solve, so that it can be undone.
class FormerMotion {
public:
    FormerMotion(const GapScratch& scratch, const std::vector<BodyId>& bodies)
    {
        for (const BodyId body : bodies)
            before_.push_back({body, scratch.bodies[body].velocity, scratch.bodies[body].spin});
    }
    void restore(GapScratch& scratch) const
    {
        for (const Before& before : before_) {
            scratch.bodies[before.body].velocity = before.velocity;
            scratch.bodies[before.body].spin = before.spin;
        }
    }

private:
    struct Before {
        BodyId body;
        Vec3 velocity, spin;
    };
    std::vector<Before> before_;
};

/// The bodies that a solve may move. Sorted.
std::vector<BodyId> moversOf(const GapScratch& scratch, const std::vector<std::size_t>& rows)
{
    std::vector<BodyId> movers;
    for (const std::size_t r : rows) {
        const GapRow& row = scratch.rows[r];
        if (row.movesA) movers.push_back(row.a);
        if (row.movesB) movers.push_back(row.b);
    }
    sortUnique(movers);
    return movers;
}

/// Tells whether a solve throws its bodies. Pinned ones are as heavy as the world: what is wedged
/// between two of them that close cannot obey both, and each sweep throws it harder; and what hangs
/// on those that swing is driven by them. More than the energy there was and that of a step's fall
/// is such a throw. Allowed to double it, five tonnes on twenty links of two kilograms got a fifth
/// of their fall back within six seconds.
class LevelEnergy {
public:
    LevelEnergy(const GapScratch& scratch, const std::vector<BodyId>& movers)
    {
        for (const BodyId body : movers)
            bodies_.push_back({body, scratch.bodies[body].inverseInertia.inverse()});
        before_ = energy(scratch);
    }

    bool isThrown(const GapScratch& scratch, double dt) const
    {
        double fall = 0.0;
        for (const Mover& mover : bodies_) {
            const GapBody& b = scratch.bodies[mover.body];
            fall += 0.5 * (dt * b.pull).squaredNorm() / b.inverseMass;
        }
        return energy(scratch) > before_ + fall;
    }

private:
    struct Mover {
        BodyId body;
        Mat3 inertia;
    };
    double energy(const GapScratch& scratch) const
    {
        double sum = 0.0;
        for (const Mover& mover : bodies_) {
            const GapBody& b = scratch.bodies[mover.body];
            sum += 0.5 *
                   (b.velocity.squaredNorm() / b.inverseMass + b.spin.dot(mover.inertia * b.spin));
        }
        return sum;
    }

    std::vector<Mover> bodies_;
    double before_ = 0.0;  // [J]
};

void solveRows(GapScratch& scratch, const std::vector<std::size_t>& rows, int most, double enough)
{
    for (int sweep = 0; sweep < most; ++sweep) {
        double residual = 0.0;
        const auto visit = [&](std::size_t r) {
            GapRow& row = scratch.rows[r];
            if (!row.movesA && !row.movesB) return;  // one is pinned, and the other unmoved by it
            residual =
                std::max(residual, visitRow(row, scratch.bodies[row.a], scratch.bodies[row.b]));
        };
        for (std::size_t r : rows) visit(r);
        for (std::size_t i = rows.size(); i-- > 0;) visit(rows[i]);
        if (residual < enough) break;
    }
}

/// The same without friction.
void solveNormals(GapScratch& scratch, const std::vector<std::size_t>& rows, int most,
                  double enough)
{
    thread_local std::vector<double> frictions;
    frictions.clear();
    for (std::size_t r : rows) {
        frictions.push_back(scratch.rows[r].friction);
        scratch.rows[r].friction = 0.0;
    }
    solveRows(scratch, rows, most, enough);
    for (std::size_t i = 0; i < rows.size(); ++i) scratch.rows[rows[i]].friction = frictions[i];
}

/// Of weight, to rounding: what one level leaves open all below it bear [m/s].
double solvedEnough(const GapScratch& scratch, const GapIsland& island, double dt)
{
    return 1e-9 * dt * strongestPull(scratch, island);
}

/// Speed at which a row closes visibly within a step, beyond its target [m/s].
double visibleSpeed(const World& world, double dt, const GapIsland& island, const GapRow& row)
{
    const double visible = isHeap(island) ? kVisibleInHeaps : kVisibleWhenSolved;
    return visible * smallerRadius(world, row.a, row.b) / dt;
}

/// How fast the surfaces at a row close beyond its target [m/s].
double closingOf(const GapScratch& scratch, const GapRow& row)
{
    const Vec3 u = velocityAt(row, scratch.bodies[row.a], scratch.bodies[row.b]);
    return row.target - u.dot(row.normal);
}

/// The fastest of these.
double closingOf(const GapScratch& scratch, const std::vector<std::size_t>& rows)
{
    double closing = 0.0;
    for (const std::size_t r : rows)
        closing = std::max(closing, closingOf(scratch, scratch.rows[r]));
    return closing;
}

bool closesVisibly(const World& world, double dt, const GapScratch& scratch,
                   const GapIsland& island, const GapRow& row)
{
    return closingOf(scratch, row) > visibleSpeed(world, dt, island, row);
}

/// The pairs of those islands of a block of which a row still closes visibly.
std::vector<std::size_t> pairsForShock(const World& world, double dt, const GapBlock& block,
                                       const GapScratch& scratch)
{
    std::vector<char> pairCloses(block.pairs.size());
    forPairs(block, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        const auto rows = scratch.rowsOf(pair);
        pairCloses[pair.place] = std::any_of(rows.begin(), rows.end(), [&](const GapRow& row) {
            return closesVisibly(world, dt, scratch, scratch.islands[pair.island], row);
        });
    });
    std::vector<std::size_t> pairs;
    for (const std::size_t island : block.islands) {
        const std::vector<std::size_t>& all = scratch.islands[island].pairs;
        if (std::ranges::any_of(all,
                                [&](std::size_t i) { return pairCloses[scratch.pairs[i].place]; }))
            pairs.insert(pairs.end(), all.begin(), all.end());
    }
    return pairs;
}

/// Fills `rows` with those of the pairs.
void collectRows(const GapScratch& scratch, std::span<const std::size_t> pairs,
                 std::vector<std::size_t>& rows)
{
    rows.clear();
    forRows(scratch, pairs, [&](std::size_t r) { rows.push_back(r); });
}

/// Sorted within each level.
void groupByLevel(const GapScratch& scratch, std::span<const std::size_t> pairs, Groups& byLevel)
{
    thread_local std::vector<std::size_t> sorted;
    sorted.assign(pairs.begin(), pairs.end());
    std::sort(sorted.begin(), sorted.end());
    const auto level = [&](std::size_t i) {
        return static_cast<std::size_t>(levelOf(scratch.levels, scratch.pairs[i].bodies));
    };
    std::size_t levels = 0;
    for (const std::size_t i : pairs) levels = std::max(levels, level(i) + 1);
    byLevel.sort(sorted, levels, level);
}

/// Solves the rows of pairs that share bodies beside bodies that are pinned, if one closes visibly.
/// The rows keep their impulses. False when nothing was to be done.
///
/// What closes as fast afterwards as it did before is left as it was. Friction of a brick that lies
/// on three of which each goes its own way, pinned, cannot obey all of them: it turned, and those
/// above it turned more. In 18 layers with a thousandth of a millimetre of air in each, 0.14 mm/s
/// at the lowest became 40 at the top.
bool shockCluster(const World& world, double dt, std::span<const std::size_t> pairs,
                  GapScratch& scratch)
{
    struct Remembered {
        Vec3 impulse, couple;
    };
    thread_local std::vector<std::size_t> rows;
    thread_local std::vector<Remembered> remembered;
    collectRows(scratch, pairs, rows);
    const GapIsland& island = scratch.islands[scratch.pairs[pairs.front()].island];
    const bool closes = std::any_of(rows.begin(), rows.end(), [&](std::size_t r) {
        return closesVisibly(world, dt, scratch, island, scratch.rows[r]);
    });
    if (!closes) return false;
    remembered.clear();
    double enough =
        std::max(solvedEnough(scratch, island, dt), roundingOfSpeeds(world, island, dt));
    for (const std::size_t r : rows) {
        GapRow& row = scratch.rows[r];
        remembered.push_back({row.impulse, row.couple});
        prepareRow(scratch.bodies, row);
        enough = std::max(enough, kWellBelow * visibleSpeed(world, dt, island, row));
    }
    const std::vector<BodyId> movers = moversOf(scratch, rows);
    const FormerMotion before(scratch, movers);
    const LevelEnergy energy(scratch, movers);
    const double closingBefore = closingOf(scratch, rows);
    solveRows(scratch, rows, kShockSweeps, enough);
    const bool isUndone = energy.isThrown(scratch, dt) || closingOf(scratch, rows) >= closingBefore;
    if (isUndone) before.restore(scratch);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        GapRow& row = scratch.rows[rows[i]];
        const Vec3 withShock = row.worldImpulse(), coupleWithShock = row.couple;
        row.impulse = remembered[i].impulse;
        row.couple = remembered[i].couple;
        if (isUndone) continue;
        const Vec3 extra = withShock - row.worldImpulse();
        const Vec3 extraCouple = coupleWithShock - row.couple;
        GapBody &a = scratch.bodies[row.a], &b = scratch.bodies[row.b];
        if (row.movesA) a.angularImpulse += (row.rA.cross(extra) + extraCouple) / a.heavier;
        if (row.movesB) b.angularImpulse -= (row.rB.cross(extra) + extraCouple) / b.heavier;
    }
    return true;
}

/// What pulls at the bodies of an island in a step, all together [N s].
double weightOf(const GapScratch& scratch, const GapIsland& island, double dt)
{
    double weight = 0.0;
    for (const BodyId body : island.movers)
        weight += dt * scratch.bodies[body].pull.norm() / scratch.bodies[body].inverseMass;
    return weight;
}

/// Solves the rows of a level beside bodies that belong to others: pinned, as they were before
/// anything pulled at them.
void solveFromAbove(std::size_t level, const std::vector<std::size_t>& rows, double enough,
                    GapScratch& scratch)
{
    PinnedBodies pinned(scratch);
    const auto pin = [&](BodyId body) {
        GapBody& b = scratch.bodies[body];
        if (!b.isMovable() || scratch.levels.level[body] == static_cast<int>(level)) return;
        pinned.pin(body);
        b.velocity = b.velocityBefore;
        b.spin = b.spinBefore;
    };
    for (const std::size_t r : rows) {
        pin(scratch.rows[r].a);
        pin(scratch.rows[r].b);
    }
    for (const std::size_t r : rows) {
        scratch.rows[r].impulse = scratch.rows[r].couple = Vec3::Zero();
        prepareRow(scratch.bodies, scratch.rows[r]);
    }
    // Friction would hold what the first of many corners turns before the others have carried
    // anything, and hand that down too: in a tower of bricks all of it slid, to keep a balance
    // that needed none.
    solveNormals(scratch, rows, kWeightSweeps, enough);
    solveRows(scratch, rows, kWeightSweeps, enough);
    pinned.release();
}

/// Gives the bodies of other levels what the rows of this one bear.
void handOn(std::size_t level, const std::vector<std::size_t>& rows, GapScratch& scratch)
{
    const auto isOfOther = [&](BodyId body) {
        return scratch.levels.level[body] != static_cast<int>(level);
    };
    for (const std::size_t r : rows) {
        GapRow& row = scratch.rows[r];
        prepareRow(scratch.bodies, row);
        const Vec3 impulse = row.worldImpulse();
        const auto hand = [&](BodyId body, const Vec3& arm, const Vec3& j, const Vec3& couple) {
            applyTo(scratch.bodies[body], arm, j);
            applyCoupleTo(scratch.bodies[body], couple);
        };
        if (row.movesA && isOfOther(row.a)) hand(row.a, row.rA, impulse, row.couple);
        if (row.movesB && isOfOther(row.b)) hand(row.b, row.rB, -impulse, -row.couple);
    }
}

void handWeightDown(double dt, const GapIsland& island, GapScratch& scratch)
{
    const FormerMotion before(scratch, island.movers);
    const double enough = solvedEnough(scratch, island, dt);
    const double most = kMostOfWeight * weightOf(scratch, island, dt);
    thread_local Groups byLevel;
    groupByLevel(scratch, island.pairs, byLevel);
    thread_local std::vector<std::size_t> rows;
    for (std::size_t level = byLevel.size(); level-- > 0;) {
        collectRows(scratch, byLevel[level], rows);
        solveFromAbove(level, rows, enough, scratch);
        handOn(level, rows, scratch);
        const bool isWeight = std::ranges::all_of(
            rows, [&](std::size_t r) { return scratch.rows[r].impulse.x() <= most; });
        if (isWeight) continue;
        before.restore(scratch);
        forRows(scratch, island.pairs, [&](std::size_t r) {
            scratch.rows[r].impulse = scratch.rows[r].couple = Vec3::Zero();
        });
        return;
    }
}

}  // namespace

void handWeightDown(double dt, const GapBlock& block, GapScratch& scratch)
{
    forIslands(scratch, block, [&](std::size_t i) {
        const GapIsland& island = scratch.islands[i];
        if (!island.isRemembered) handWeightDown(dt, island, scratch);
    });
}

void propagateShockUp(const World& world, double dt, const GapBlock& block, GapScratch& scratch)
{
    Groups byLevel, clusters;
    groupByLevel(scratch, pairsForShock(world, dt, block, scratch), byLevel);
    PinnedBodies pinned(scratch);
    std::vector<char> isShocked;
    for (std::size_t level = 0; level < byLevel.size(); ++level) {
        for (const std::size_t i : byLevel[level]) {
            for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
                if (scratch.levels.isSupported[body] &&
                    scratch.levels.level[body] != static_cast<int>(level))
                    pinned.pin(body);
            }
        }
        groupByBodies(scratch, byLevel[level], clusters);
        isShocked.assign(clusters.size(), 0);
        forEach(clusters.size(), 4, [&](std::size_t c) {
            isShocked[c] = shockCluster(world, dt, clusters[c], scratch);
        });
        pinned.release();
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            if (!isShocked[c]) continue;
            forRows(scratch, clusters[c],
                    [&](std::size_t r) { prepareRow(scratch.bodies, scratch.rows[r]); });
        }
    }
}

}  // namespace scree
