// Places that are hit at once, beside the plain twin: rows visited one by one, through their
// bodies.
#include "core/dynamics/gaps/gap_together.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/dynamics/gaps/gap_visit.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/gap_energy.h"

namespace scree::test {
namespace {

/// A body that lands with a face on the ground and with another on a body that flies, at places
/// that lie close beside each other.
struct Landing {
    std::vector<GapBody> bodies{3};  // the ground, who lands, who flies
    std::vector<GapRow> rows;

    Landing(std::uint64_t seed, std::size_t places)
    {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            GapBody& body = bodies[i];
            body.velocity = i == 0 ? Vec3::Zero() : Vec3(signedUnits(seed, 10 * i));
            body.spin = i == 0 ? Vec3::Zero() : Vec3(signedUnits(seed, 10 * i + 3));
            body.inverseMass = i == 0 ? 0.0 : 1.5 + signedUnit(seed, 10 * i + 6);
            const Mat3 turned = exponentialMap(signedUnits(seed, 10 * i + 7)).toRotationMatrix();
            const Vec3 moments = Vec3(2.0, 3.0, 4.0) * (i == 0 ? 0.0 : 1.0);
            body.inverseInertia = turned * moments.asDiagonal() * turned.transpose();
        }
        bodies[1].velocity.y() = -3.0;
        const double friction = 0.4 * randomUnit(seed, 1, 0);
        for (std::size_t n = 0; n < 2 * places; ++n) {
            GapRow row{};
            const bool isOnGround = n < places;
            const Vec3 at = signedUnits(seed, 100 + 3 * n);
            row.a = 1;
            row.b = isOnGround ? 0 : 2;
            row.movesA = true;
            row.movesB = !isOnGround;
            row.rA = isOnGround ? Vec3(at.x(), -1.0 + 0.1 * at.y(), at.z())
                                : Vec3(1.0 + 0.1 * at.x(), 0.3 * at.y(), 0.3 * at.z());
            row.rB = row.rA - Vec3(2.0, 0.0, 0.0);
            row.normal = isOnGround ? Vec3(0.0, 1.0, 0.0) : Vec3(-1.0, 0.0, 0.0);
            row.friction = friction;
            prepareRow(bodies, row);
            const double u = velocityAt(row, bodies[row.a], bodies[row.b]).dot(row.normal);
            row.target = -0.3 * std::min(u, 0.0);
            rows.push_back(row);
        }
    }

    HitTogether solved(double enough) const
    {
        HitTogether together;
        together.begin(bodies);
        for (const GapRow& row : rows) together.add(row);
        together.solve(enough);
        return together;
    }

    void apply(const HitTogether& together)
    {
        rows = together.rows();
        for (const GapRow& row : rows) {
            if (row.movesA) applyTo(bodies[row.a], row.rA, row.worldImpulse());
            if (row.movesB) applyTo(bodies[row.b], row.rB, -row.worldImpulse());
        }
    }

    /// How much another visit of all rows would change [m/s].
    double residual() const
    {
        Landing another = *this;
        double most = 0.0;
        for (GapRow& row : another.rows)
            most = std::max(most, visitRow(row, another.bodies[row.a], another.bodies[row.b]));
        return most;
    }
};

constexpr double kEnough = 1e-3;  // of 3 m/s, as a blow is solved

/// Whether rows visited one by one come to an end in as many visits.
bool isSolvedOneByOne(Landing landing)
{
    for (int sweep = 0; sweep < 200; ++sweep) {
        double changed = 0.0;
        for (GapRow& row : landing.rows) {
            changed =
                std::max(changed, visitRow(row, landing.bodies[row.a], landing.bodies[row.b]));
        }
        if (changed <= kEnough) return true;
    }
    return false;
}

TEST(HitTogether, LeavesBodiesAsTheirOwnVisitsWouldAndSeldomGivesUp)
{
    int unsolved = 0, unsolvedOneByOne = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Landing landing(seed, 1 + seed % 5);
        ASSERT_GT(landing.residual(), 0.1) << seed;
        unsolvedOneByOne += !isSolvedOneByOne(landing);
        landing.apply(landing.solved(kEnough));
        EXPECT_LE(landing.residual(), 1e-2) << seed;
        unsolved += landing.residual() > 3.0 * kEnough;
    }
    EXPECT_GT(unsolvedOneByOne, 4 * unsolved) << unsolved;
}

TEST(HitTogether, TellsTheWorkOfItsImpulses)
{
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Landing landing(seed, 3);
        const double before = kineticEnergy(landing.bodies);
        const HitTogether together = landing.solved(kEnough);
        landing.apply(together);
        EXPECT_NEAR(together.work(), kineticEnergy(landing.bodies) - before, 1e-12 * before)
            << seed;
        EXPECT_LT(together.work(), 0.0) << seed;
    }
}

}  // namespace
}  // namespace scree::test
