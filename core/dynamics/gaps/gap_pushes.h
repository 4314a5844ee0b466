// Pushes of method `scree`: rows that move bodies apart, in positions only. As impulses change
// velocities, so these change places, to first order.  [A52]
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Overlap that is left alone, as a share of the smaller body: removing all of it shook stacks.
inline constexpr double kSlop = 1e-4;

/// A body as pushes see it.
struct alignas(64) PushedBody {
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();  ///< so far [m], [rad]
    double inverseMass = 0.0;                        ///< 0: no row has it yet
    bool isPushed = false;
    Mat3 inverseInertia = Mat3::Zero();
};

/// Of a row what pushes look at: less than half of it.
struct PushRow {
    BodyId a, b;
    bool movesA, movesB;
    Vec3 rA, rB, normal;
    double inverseMass;    ///< of the separation
    double wanted;         ///< separation [m]; negative: how far it may close
    double impulse = 0.0;  ///< [kg m]
};

/// How much deeper a gap of a row is than it may stay [m]; negative: how far it may close.
double excessOf(const World& world, const GapRow& row, double gap, double left);

/// To be called for the bodies that a row moves before it is made; they are `lighter` times as
/// easily pushed as moved.
void takeUp(const GapBody& body, double lighter, PushedBody& pushed);

/// A row that has not pushed yet; its bodies have been taken up.
PushRow pushRow(const GapRow& row, double wanted, const std::vector<PushedBody>& bodies);

/// Lets rows push as far as they want, or take back, one after the other. With `give` c none moves
/// its bodies farther than 1/√(2c) times that. Answers the largest change of a separation [m].
double sweep(std::vector<PushRow>& rows, double give, std::vector<PushedBody>& bodies);

/// The same for some of the rows.
double sweep(std::vector<PushRow>& rows, std::span<const std::size_t> some, double give,
             std::vector<PushedBody>& bodies);

/// Moves a body to where it has been pushed. Answers whether that is more than a push may do: then
/// not all the way.
bool displace(World& world, BodyId id, const PushedBody& pushed);

}  // namespace scree
