// Places that are hit at once, solved at once.  [algorithm 14.1]
//
// They are few, and belong to a body or two: how each impulse changes the velocity at every other
// place is worked out once, and no visit goes through the bodies.
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
    /// What moves one of the two bodies of a row.
    struct Side {
        BodyId body;
        bool moves;
        Mat3 along,
            turning;  ///< of its surface by the body's velocity and spin, in the row's frame
        Mat3 velocity, spin;  ///< of the body by an impulse in the row's frame
    };

    void respond();
    void solveAnew(double enough);
    double leaveFriction(double enough);
    double sweep(bool isUp);
    double visit(std::size_t i);
    double goOn(double energyBefore);
    void push(std::size_t i, const Vec3& impulse);

    const std::vector<GapBody>* bodies_ = nullptr;
    std::vector<GapRow> rows_;
    std::vector<Side> sides_;  // two of each row
    // In the frames of the rows: velocities now and without impulses, impulses before the last
    // sweep and the way they went in it, and a column of changes of velocity for each number of
    // an impulse.
    std::vector<Vec3> velocity_, velocityBefore_, before_, way_;
    std::vector<double> response_;
};

}  // namespace scree
