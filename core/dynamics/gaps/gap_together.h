// Places that are hit at once, solved at once.  [algorithm 14.1]
//
// What a visit needs of the bodies is laid out once, in the frames of the rows.
#pragma once

#include "core/dynamics/gaps/gap_rows.h"

namespace scree {

/// Resistance to rolling and spinning is left to the contacts.
class HitTogether {
public:
    /// Rows that begin without impulses, and the bodies they are rows of.
    void begin(const std::vector<GapBody>& bodies);
    void add(const GapRow& row) { rows_.push_back(row); }

    /// Fills the impulses of the rows, with as much friction as adds no energy: Newton's rule at
    /// several places can, and without friction cannot. Answers the share of it that is
    /// left.
    /// `enough`: what a sweep may still change [m/s].  [A33]
    double solve(double enough);

    const std::vector<GapRow>& rows() const { return rows_; }

    /// Of the impulses [J].
    double work() const;

private:
    /// One of the two bodies of a row.
    struct Side {
        std::size_t place;  ///< in changes_
        bool moves;
        double inverseMass;
        Mat3 surfaceFromSpin;  ///< velocity of its surface, in the row's frame
        Mat3 spinFromImpulse;  ///< of an impulse in that frame
    };
    struct PlacedRow {
        Mat3 worldFromFrame;
        Side a, b;
    };
    /// By the impulses so far.
    struct Change {
        Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    };

    void placeRows();
    std::size_t placeOf(BodyId body);
    Vec3 velocityAtRow(std::size_t i) const;
    void solveAnew(double enough);
    double leaveFriction(double enough);
    double sweep(bool isUp);
    double visit(std::size_t i);
    double goOn(double energyBefore);
    void push(std::size_t i, const Vec3& impulse);

    const std::vector<GapBody>* bodies_ = nullptr;
    std::vector<GapRow> rows_;
    std::vector<PlacedRow> placed_;      // parallel to rows_
    std::vector<BodyId> taken_;          // bodies that have a place
    std::vector<std::int32_t> placeOf_;  // per body: its place, or -1
    std::vector<Change> changes_;        // by place
    // In the frames of the rows: velocities without impulses, impulses before the last sweep and
    // the way they went in it.
    std::vector<Vec3> velocityBefore_, before_, way_;
};

}  // namespace scree
