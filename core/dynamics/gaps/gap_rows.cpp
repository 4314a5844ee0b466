#include "core/dynamics/gaps/gap_rows.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_scratch.h"
#include "core/dynamics/rolling_friction.h"
#include "core/geometry/surface_curvature.h"
#include "core/math/lanes.h"

namespace scree {
namespace {

/// A place that has moved less than this share of the smaller body since the last step may take
/// over an impulse although its features have changed.
constexpr double kSamePlace = 0.05;
constexpr double kAnywhere = std::numeric_limits<double>::infinity();

bool isBefore(const RememberedContact& contact, const BodyPair& bodies)
{
    return bodiesOf(contact) < bodies;
}

Vec3 anyTangent(const Vec3& normal)
{
    const Vec3 aside = std::abs(normal.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
    return normal.cross(aside).normalized();
}

/// The second axis in the place of the first, the third in that of the second, the first in that
/// of the third.
Lanes3 shifted(const Lanes3& axes)
{
    const auto shift = [](Lanes x) { return Lanes{x[1], x[2], x[0], x[3]}; };
    return {shift(axes.x), shift(axes.y), shift(axes.z)};
}

/// Of a symmetric 2×2 matrix.
double largestEigenvalue(double tt, double ts, double ss)
{
    const double half = 0.5 * (tt - ss);
    return 0.5 * (tt + ss) + std::sqrt(half * half + ts * ts);
}

/// The paper's raw coefficient takes an angular speed from the bodies for each unit of normal
/// impulse, a lever arm a couple: what turns one into the other is the response to a couple. A
/// couple against rolling has to stop the centre too; one against spinning about the normal only
/// the spin.  [A49]
void resistRolling(const World& world, const GapScratch& scratch, const RollingFriction& rolling,
                   GapRow& row)
{
    row.rollingArm = row.spinningArm = row.rollResponse = 0.0;
    row.couple = Vec3::Zero();
    if (rolling.isNone() || (!row.movesA && !row.movesB)) return;
    const Mat3 response = coupleResponse(row, scratch.bodies[row.a], scratch.bodies[row.b]);
    const Shape& shapeA = world.shapeOf(row.a);
    const Shape& shapeB = world.shapeOf(row.b);
    const Shape& finer =
        !row.movesA || (row.movesB && shapeB.unitMass.volume < shapeA.unitMass.volume) ? shapeB
                                                                                       : shapeA;
    const auto curvatureOf = [&](const Shape& shape, BodyId body, const Vec3& r) {
        const Vec3 place = world.motion[body].orientation.conjugate() * r;
        return rollingCurvature(meanCurvatureOfCells(shape, place), shape);
    };
    const double curvature =
        curvatureOf(shapeA, row.a, row.rA) + curvatureOf(shapeB, row.b, row.rB);
    const double factor = curvatureFactor(curvature, finer);
    const double about = row.normal.dot(response * row.normal);
    const Mat3 rollers = rollingResponse(inertiaOf(scratch.bodies[row.a], row.movesA), row.rA,
                                         inertiaOf(scratch.bodies[row.b], row.movesB), row.rB);
    const double tt = row.tangent.dot(rollers * row.tangent);
    const double ss = row.secondTangent().dot(rollers * row.secondTangent());
    const double ts = row.tangent.dot(rollers * row.secondTangent());
    if (!(tt + ss > 0.0)) return;  // it holds what numbers do not tell from fixed
    row.rollResponse = largestEigenvalue(tt, ts, ss);
    row.rollingArm = factor * (rolling.rolling + rolling.rawRolling / (0.5 * (tt + ss)));
    row.spinningArm = factor * (rolling.spinning + rolling.rawSpinning / about);
}

/// Hands the remembered impulses of one pair to its rows: by feature, and what is left to the
/// nearest row that got none. Two round bodies may touch at several places of the same name, not
/// all of which bore: those that belong together most closely come first.
void warmStart(const World& world, double dt, const RememberedContact* begin,
               const RememberedContact* end, GapRow* firstRow, GapRow* lastRow,
               const std::vector<GapContact>& contacts)
{
    struct Match {
        double away;  // [m]
        std::size_t row, remembered;

        auto operator<=>(const Match&) const = default;
    };
    const BodyId a = firstRow->a;
    const double smaller = smallerRadius(world, firstRow->a, firstRow->b);
    const Mat3 worldFromA = world.motion[a].orientation.toRotationMatrix();
    thread_local std::vector<char> isTaken, isGiven;
    thread_local std::vector<Match> matches;
    isTaken.assign(static_cast<std::size_t>(end - begin), 0);
    isGiven.assign(static_cast<std::size_t>(lastRow - firstRow), 0);
    const auto give = [&](std::size_t r, std::size_t m) {
        GapRow& row = firstRow[r];
        const Vec3 impulse = dt * begin[m].force;
        row.impulse = {std::max(impulse.dot(row.normal), 0.0), impulse.dot(row.tangent),
                       impulse.dot(row.secondTangent())};
        row.couple = row.resistsSpin() ? Vec3(dt * begin[m].couple) : Vec3::Zero();
        isTaken[m] = isGiven[r] = 1;
    };
    const auto giveNearestFirst = [&](double farthest, const auto& isMeant) {
        matches.clear();
        for (std::size_t m = 0; m < isTaken.size(); ++m) {
            if (isTaken[m]) continue;
            const Vec3 place = worldFromA * begin[m].place;
            for (std::size_t r = 0; r < isGiven.size(); ++r) {
                if (isGiven[r] || !isMeant(r, m)) continue;
                const double away = (firstRow[r].rA - place).norm();
                if (away < farthest) matches.push_back({away, r, m});
            }
        }
        std::sort(matches.begin(), matches.end());
        for (const auto& [away, r, m] : matches) {
            if (!isGiven[r] && !isTaken[m]) give(r, m);
        }
    };
    giveNearestFirst(kAnywhere, [&](std::size_t r, std::size_t m) {
        return begin[m].feature == contacts[r].feature;
    });
    giveNearestFirst(kSamePlace * smaller, [](std::size_t, std::size_t) { return true; });
}

}  // namespace

void prepareRow(const std::vector<GapBody>& bodies, GapRow& row)
{
    const GapBody& a = bodies[row.a];
    const GapBody& b = bodies[row.b];
    row.movesA = a.isMovable() && !row.isUnmovedA;
    row.movesB = b.isMovable() && !row.isUnmovedB;
    row.tangent = anyTangent(row.normal);

    // The response in the axes of the row, a lane each: normal, tangent, second. What one turns
    // into itself, and what into the next.
    const Lanes3 axes = lanesOf(row.normal, row.tangent, row.secondTangent(), Vec3::Zero());
    Lanes own = kNoLanes, next = kNoLanes;
    const auto addBody = [&](const GapBody& body, const Vec3& r) {
        const Lanes3 arms = cross(Lanes3::all(r), axes);
        const Lanes3 turned = SymmetricLanes::all(body.inverseInertia) * arms;
        own += body.inverseMass + dot(arms, turned);
        next += dot(shifted(arms), turned);
    };
    if (row.movesA) addBody(a, row.rA);
    if (row.movesB) addBody(b, row.rB);
    const double tt = own[1], ss = own[2], ts = next[1];
    row.inverseNormalMass = own[0];
    row.normalIntoFriction[0] = next[0];
    row.normalIntoFriction[1] = next[2];
    const double determinant = tt * ss - ts * ts;
    row.frictionMass[0] = ss / determinant;
    row.frictionMass[1] = -ts / determinant;
    row.frictionMass[2] = tt / determinant;
    row.slideMass = 1.0 / largestEigenvalue(tt, ts, ss);
}

void buildRows(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
               GapScratch& scratch)
{
    const std::vector<RememberedContact>& memory = world.contactMemory.contacts;
    parallelFor(block.pairs.size(), 32, [&](std::size_t begin, std::size_t end) {
        // Both lists are sorted.
        auto known = std::lower_bound(memory.begin(), memory.end(),
                                      scratch.pairs[block.pairs[begin]].bodies, isBefore);
        for (std::size_t i = begin; i < end; ++i) {
            fetchContactsAfter(scratch, block.pairs[i]);
            if (i + kPairsAhead < end)
                fetchRows(world, scratch, scratch.pairs[block.pairs[i + kPairsAhead]]);
            GapPair& pair = scratch.pairs[block.pairs[i]];
            const std::vector<GapContact>& contacts = scratch.contactsOf(pair);
            const auto [a, b] = pair.bodies;
            const PairSurface surface = surfaceOf(world, settings, pair.bodies);
            const Vec3 bFromA = world.motion[a].position - world.motion[b].position;
            const bool areBalls = world.shapeOf(a).isBall() && world.shapeOf(b).isBall();
            const bool isUnmovedA = isUnmovedBy(world, a, b), isUnmovedB = isUnmovedBy(world, b, a);
            while (known != memory.end() && isBefore(*known, pair.bodies)) ++known;
            const auto firstKnown = known;
            while (known != memory.end() && bodiesOf(*known) == pair.bodies) ++known;
            pair.isCarried = firstKnown != known;
            for (std::size_t r = pair.begin; r < pair.end; ++r) {
                GapRow& row = scratch.rows[r];
                placeRow(pair.bodies, contacts[r - pair.begin], bFromA, row);
                row.friction = surface.friction;
                row.restitution = surface.restitution;
                row.target = 0.0;
                row.wasHit = false;
                row.isOfBlow = false;
                row.isOfBalls = areBalls;
                row.impulse = Vec3::Zero();
                row.squeeze = 0.0;
                row.isUnmovedA = isUnmovedA;
                row.isUnmovedB = isUnmovedB;
                prepareRow(scratch.bodies, row);
                SCREE_CHECK(row.movesA || row.movesB, "a contact that moves nobody has no impulse");
                resistRolling(world, scratch, surface.rolling, row);
            }
            if (!pair.isCarried) continue;
            GapRow* rows = &scratch.rows[pair.begin];
            warmStart(world, dt, &*firstKnown, &*firstKnown + (known - firstKnown), rows,
                      rows + (pair.end - pair.begin), contacts);
        }
    });
    for (const std::size_t i : block.pairs) {
        const GapPair& pair = scratch.pairs[i];
        GapIsland& island = scratch.islands[pair.island];
        // What was put to sleep touching has not borne anything yet.
        island.isRemembered =
            island.isRemembered || std::ranges::any_of(scratch.rowsOf(pair), &GapRow::carries);
    }
}

}  // namespace scree
